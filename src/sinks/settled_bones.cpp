#include "sinks/settled_bones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "core/lens.h"
#include "sinks/kept_frame.h"

namespace duo {
namespace {

constexpr std::size_t kMostWaiting = 75;
constexpr int kLastsFrames = 10;
constexpr double kSame_m = 1e-4, kWrong_m = 0.02;

bool is_known(const Joint& joint) { return joint.state != JointState::kLost; }

/// How long a person's bones are.
///
/// Units  metres, of the bone that ends in a joint; 0: not known
class Bones {
 public:
  void see(const Person& person) {
    bool same = true;
    for (std::size_t j = 1; j < kBodyJointIds; ++j) {
      const auto now = length_of(person, j);
      if (!now) continue;
      same &= std::abs(*now - length_m_[j]) < kSame_m;
      length_m_[j] = *now;
    }
    same_for_ = same ? same_for_ + 1 : 0;
  }
  /// Whether they have lasted for a while.
  bool last() const { return same_for_ >= kLastsFrames; }
  /// Takes over what has turned out to be wrong, or was not known.
  void mend(const Person& person) {
    for (std::size_t j = 1; j < kBodyJointIds; ++j)
      if (const auto now = length_of(person, j); now && std::abs(*now - length_m_[j]) > kWrong_m) length_m_[j] = *now;
  }

  /// Gives the person these lengths.
  void put_into(Person& person) const {
    std::array<Vec3, Skeleton::kMostJoints> places = {};
    places[0] = person.joints[0].p_in_rig_m;
    Vec3 off;
    int count = 0;
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Vec3 old = person.joints[j].p_in_rig_m;
      if (j > 0) {
        const std::size_t from = parent(j);
        const Vec3 way = old - person.joints[from].p_in_rig_m;
        const double now = norm(way), length = j < kBodyJointIds ? length_m_[j] : 0;
        places[j] = places[from] + (length > 0 && now > 1e-6 ? length / now : 1) * way;
      }
      if (!is_known(person.joints[j])) continue;
      off = off + (old - places[j]);
      ++count;
    }
    const Vec3 shift = (1.0 / std::max(count, 1)) * off;
    for (std::size_t j = 0; j < person.count(); ++j) person.joints[j].p_in_rig_m = places[j] + shift;
  }

 private:
  static std::optional<double> length_of(const Person& person, std::size_t joint) {
    const Joint &end = person.joints[joint], &from = person.joints[parent(joint)];
    if (!is_known(end) || !is_known(from)) return std::nullopt;
    return norm(end.p_in_rig_m - from.p_in_rig_m);
  }
  static std::size_t parent(std::size_t joint) { return static_cast<std::size_t>(kBodyHands.joints[joint].parent); }

  std::array<double, kBodyJointIds> length_m_ = {};
  int same_for_ = 0;
};

class SettledBones final : public Sink {
 public:
  SettledBones(std::unique_ptr<Sink> sink, const Lens& lens, const Mat3& rig_from_left)
      : sink_(std::move(sink)), lens_(lens), left_from_rig_(transposed(rig_from_left)) {}

  Result<void> write(const TrackedFrame& frame) override {
    waiting_.emplace_back().keep(frame, false);
    for (Person& person : waiting_.back().people) {
      if (person.find(JointId::kPelvis) == nullptr) continue;  // an arm is measured where it is
      Known& known = known_[person.id];
      if (known.settled) {
        known.bones.mend(person);
        give(known.bones, person);
      } else {
        known.bones.see(person);
        if (known.bones.last()) settle(person.id, known);
      }
    }
    if (waiting_.size() > kMostWaiting)
      for (auto& [id, known] : known_)
        if (has(waiting_.front(), id)) settle(id, known);
    while (!waiting_.empty() && may_go(waiting_.front())) DUO_TRY(let_go());
    return {};
  }
  Result<void> flush() override {
    for (auto& [id, known] : known_) settle(id, known);
    while (!waiting_.empty()) DUO_TRY(let_go());
    return sink_->flush();
  }
  std::int64_t dropped() const override { return sink_->dropped(); }
  Result<void> finish() override {
    DUO_TRY(flush());
    return sink_->finish();
  }

 private:
  struct Known {
    Bones bones;
    bool settled = false;
  };

  static bool has(const KeptFrame& kept, std::uint32_t id) {
    return std::ranges::any_of(kept.people, [id](const Person& person) { return person.id == id; });
  }
  bool may_go(const KeptFrame& kept) const {
    return std::ranges::all_of(kept.people, [&](const Person& person) {
      const auto known = known_.find(person.id);
      return known == known_.end() || known->second.settled;
    });
  }
  /// Gives the frames that wait the lengths of now.
  void settle(std::uint32_t id, Known& known) {
    if (std::exchange(known.settled, true)) return;
    for (KeptFrame& kept : waiting_)
      for (Person& person : kept.people)
        if (person.id == id) give(known.bones, person);
  }
  void give(const Bones& bones, Person& person) const {
    bones.put_into(person);
    for (std::size_t j = 0; j < person.count(); ++j) {
      Joint& joint = person.joints[j];
      if (const auto pixel = lens_.pixel_of(left_from_rig_ * joint.p_in_rig_m)) {
        joint.u_px = pixel->x;
        joint.v_px = pixel->y;
      }
    }
    person.sum_up();
  }
  Result<void> let_go() {
    DUO_TRY(sink_->write(waiting_.front().view()));
    waiting_.pop_front();
    return {};
  }

  std::unique_ptr<Sink> sink_;
  Lens lens_;
  Mat3 left_from_rig_;
  std::deque<KeptFrame> waiting_;
  std::map<std::uint32_t, Known> known_;  // by person
};

}  // namespace

std::unique_ptr<Sink> with_settled_bones(std::unique_ptr<Sink> sink, const std::optional<Rig>& rig,
                                         const Rectified& rectified) {
  if (!rig || sink->wants_pictures() || sink->instant()) return sink;
  return std::make_unique<SettledBones>(std::move(sink), Lens(rig->left), rectified.rig_from_left);
}

}  // namespace duo
