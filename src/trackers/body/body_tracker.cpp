#include "trackers/body/body_tracker.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"
#include "core/lens.h"
#include "detectors/small_hands.h"
#include "duoptic/detector.h"
#include "trackers/body/body.h"

namespace duo {
namespace {

using body::Body;

constexpr std::array<const Skeleton*, 1> kBodies = {&kBody};
constexpr std::size_t kMostPeople = 8;
constexpr int kSearchEvery = 8;  // frames

class BodyTracker final : public Tracker {
 public:
  const char* name() const override { return "body"; }
  std::span<const Skeleton* const> skeletons() const override { return kBodies; }
  bool starts_by_itself() const override { return true; }
  Wants wants() const override { return {.color = true}; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<std::span<const Person>> select(const Frame& frame, std::span<const Selection> selections) override;
  std::span<const Person> track(const Frame& frame) override;
  void reset() override;

 private:
  struct Tracked {
    std::uint32_t id = 0;
    Body body;
    bool matched = false;
  };
  /// Finds the tracked person that each seen one is, the most alike first.
  void match(const body::FrameView& frame, std::span<const SeenPerson> seen);
  void match(const body::FrameView& frame, std::span<const SeenPerson> seen, double most);
  /// Whether a body that nobody owns lies over one that somebody does: the same person, marked twice.
  bool is_of_another(std::span<const SeenPerson> seen, std::size_t which) const;
  void look_at_hands(const body::FrameView& frame, std::span<const SeenPerson> seen);
  void publish(const body::FrameView& frame);

  std::optional<Lens> lens_;  // empty before prepare()
  TrackerSetup setup_;
  std::unique_ptr<Detector> detector_;
  std::unique_ptr<PeopleFinder> finder_;
  std::vector<Tracked> tracked_;
  std::vector<Tracked*> owners_;                                    // of each person seen
  std::vector<std::array<std::optional<std::size_t>, 2>> hand_of_;  // by owner
  std::vector<TurnedSquare> regions_;                               // of those who were missed
  std::vector<std::size_t> order_;                                  // of persons seen who have an owner, the nearest first
  std::vector<const body::Places*> nearer_;
  std::vector<Look> looks_;
  std::vector<SeenHand> hands_;
  std::vector<Person> people_;
  std::uint32_t next_id_ = 1;
  std::int64_t frame_ = 0;
};

Result<void> BodyTracker::prepare(const TrackerSetup& setup) {
  if (!(setup.rectified.focal_px > 0) || !(setup.rectified.baseline_m > 0) || !(setup.frame_s > 0 && setup.frame_s < 1))
    return Error{ErrorCode::kBadInput,
                 "prepare the body tracker: the setup has no geometry or no time from frame to frame; give it "
                 "what the engine's rectified() returns"};
  DUO_TRY_ASSIGN(auto detector,
                 make_detector_with_small_hands({.body = setup.body_model, .hands = true, .threads = setup.threads}));
  setup_ = setup;
  lens_.emplace(setup.rig.left);
  detector_ = std::move(detector);
  reset();
  return {};
}

Result<std::span<const Person>> BodyTracker::select(const Frame&, std::span<const Selection>) {
  return Error{ErrorCode::kBadInput,
               "select with the body tracker: it finds people by itself; to follow clicked arms choose the "
               "tracker arm"};
}

void BodyTracker::reset() {
  tracked_.clear();
  tracked_.reserve(kMostPeople);
  people_.clear();
  people_.reserve(kMostPeople);
  order_.reserve(kMostPeople);
  nearer_.reserve(kMostPeople);
  if (detector_)
    finder_ = std::make_unique<PeopleFinder>(
        *detector_, PeopleFinder::Options{.hands = false, .most = kMostPeople, .search_every = kSearchEvery});
  next_id_ = 1;
  frame_ = 0;
}

void BodyTracker::match(const body::FrameView& frame, std::span<const SeenPerson> seen) {
  constexpr double kAlike = 1, kPerhapsAlike = 2.2;
  for (Tracked& each : tracked_) each.matched = false;
  owners_.assign(seen.size(), nullptr);
  match(frame, seen, kAlike);
  match(frame, seen, kPerhapsAlike);  // who comes back elsewhere, before somebody new
}

void BodyTracker::match(const body::FrameView& frame, std::span<const SeenPerson> seen, double most) {
  while (true) {
    double least = most;
    Tracked* owner = nullptr;
    std::size_t whose = 0;
    for (Tracked& each : tracked_) {
      if (each.matched) continue;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        if (owners_[i] != nullptr) continue;
        const double unlike = each.body.unlike(frame, seen[i].body);
        if (unlike >= least) continue;
        least = unlike;
        owner = &each;
        whose = i;
      }
    }
    if (owner == nullptr) return;
    owner->matched = true;
    owners_[whose] = owner;
  }
}

bool BodyTracker::is_of_another(std::span<const SeenPerson> seen, std::size_t which) const {
  constexpr double kMost = 0.6;  // of the smaller box
  const Window& box = seen[which].box_px;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (i == which || owners_[i] == nullptr) continue;
    const Window& other = seen[i].box_px;
    const double width = std::min(box.x_end(), other.x_end()) - std::max(box.x, other.x);
    const double height = std::min(box.y_end(), other.y_end()) - std::max(box.y, other.y);
    const double least = std::min(double(box.width) * box.height, double(other.width) * other.height);
    if (width > 0 && height > 0 && width * height > kMost * least) return true;
  }
  return false;
}

void BodyTracker::look_at_hands(const body::FrameView& frame, std::span<const SeenPerson> seen) {
  looks_.clear();
  hand_of_.assign(seen.size(), {});
  const bool left = frame_ % 2 == 0;  // the other hand in the next frame
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (owners_[i] == nullptr) continue;
    if (const auto region = owners_[i]->body.hand_region(frame, seen[i].body, left)) {
      hand_of_[i][left ? 0 : 1] = looks_.size();
      looks_.push_back({frame.picture, *region});
    }
  }
  hands_.resize(looks_.size());
  detector_->hands(looks_, hands_);
}

std::span<const Person> BodyTracker::track(const Frame& frame) {
  DUO_CHECK(finder_ != nullptr);
  const body::FrameView view{{frame.disparity.d_q4, &setup_.rectified}, frame.color, setup_.frame_s, setup_.body_model};
  regions_.clear();
  for (const Tracked& each : tracked_)
    if (each.body.missed() > 0) regions_.push_back(each.body.expected_region(view));
  const std::span<const SeenPerson> seen = finder_->follow(frame.color, regions_);
  match(view, seen);
  for (std::size_t i = 0; i < seen.size() && tracked_.size() < kMostPeople; ++i) {
    if (owners_[i] != nullptr || is_of_another(seen, i)) continue;
    if (auto started = Body::start(view, seen[i].body)) {
      tracked_.push_back({next_id_++, std::move(*started), true});
      owners_[i] = &tracked_.back();
    }
  }
  look_at_hands(view, seen);
  // The nearest first: what is behind them is theirs to hide.
  order_.clear();
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (owners_[i] != nullptr) order_.push_back(i);
  std::ranges::sort(order_, {}, [&](std::size_t i) { return std::pair(owners_[i]->body.expected_trunk().z, owners_[i]->id); });
  nearer_.clear();
  for (const std::size_t i : order_) {
    Body::Hands hands;
    for (std::size_t s = 0; s < 2; ++s)
      if (hand_of_[i][s]) hands.seen[s] = &hands_[*hand_of_[i][s]];
    owners_[i]->body.track(view, seen[i].body, hands, nearer_);
    nearer_.push_back(&owners_[i]->body.places());
  }
  for (Tracked& each : tracked_)
    if (!each.matched) each.body.miss();
  constexpr int kForget = 75;  // frames
  std::erase_if(tracked_, [](const Tracked& each) { return each.body.missed() > kForget; });
  publish(view);
  ++frame_;
  return people_;
}

void BodyTracker::publish(const body::FrameView& frame) {
  people_.clear();
  const Mat3 left_from_rig = transposed(setup_.rectified.rig_from_left);
  for (const Tracked& each : tracked_) {
    Person& person = people_.emplace_back();
    person.id = each.id;
    person.skeleton = &kBody;
    each.body.publish(frame, person);
    for (std::size_t j = 0; j < person.count(); ++j) {
      Joint& joint = person.joints[j];
      if (const auto pixel = lens_->pixel_of(left_from_rig * joint.p_in_rig_m)) {
        joint.u_px = pixel->x;
        joint.v_px = pixel->y;
      }
    }
    person.sum_up();
  }
}

}  // namespace

std::unique_ptr<Tracker> make_body_tracker() { return std::make_unique<BodyTracker>(); }

}  // namespace duo
