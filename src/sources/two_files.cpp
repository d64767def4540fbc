#include "sources/two_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "sources/pairing.h"

namespace duo {
namespace {

FileSource* as_file(const std::unique_ptr<Source>& source) { return dynamic_cast<FileSource*>(source.get()); }

class TwoFiles : public FilePairs {
 public:
  explicit TwoFiles(TwoViews views) : views_(std::move(views)) {
    FileSource *left = as_file(views_.sources[0]), *right = as_file(views_.sources[1]);
    if (left != nullptr && right != nullptr) left->scale_as(*right);
  }
  Size size() const override { return left().size(); }
  std::int64_t count() const override { return std::min(left().count(), right().count()); }
  bool still() const override { return left().still(); }
  double frame_s() const override { return std::max(left().frame_s(), right().frame_s()); }
  std::string warning() const override {
    std::string all;
    const auto add = [&](const std::string& text) { all += (all.empty() || text.empty() ? "" : "; ") + text; };
    for (const std::string& note : notes_) add(note);
    add(left().warning());
    if (views_.names[0] != views_.names[1] || left().warning() != right().warning()) add(right().warning());
    return all;
  }

 protected:
  Source& left() const { return *views_.sources[0]; }
  Source& right() const { return *views_.sources[1]; }
  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// What is to be said where the files end. `pictures`: that each of them gave.
  Next end(Next left, Next right, std::array<std::int64_t, 2> pictures) {
    if (ended_) return *ended_;
    ended_ = left == Next::kCut || right == Next::kCut ? Next::kCut : Next::kEnd;
    if (left == Next::kCut || right == Next::kCut) {
      const std::size_t cut = left == Next::kCut ? 0 : 1;
      note(fmt::format("{} is cut short or damaged after {} whole pictures", views_.names[cut], pictures[cut]));
    } else if (left != right) {
      const std::size_t ended = left == Next::kEnd ? 0 : 1;
      note(fmt::format("{} ends after {} pictures, the other file goes on", views_.names[ended], pictures[ended]));
    }
    return *ended_;
  }

  TwoViews views_;
  std::optional<Next> ended_;

 private:
  std::vector<std::string> notes_;
};

class PairsByNumber final : public TwoFiles {
 public:
  PairsByNumber(TwoViews views, std::optional<RecordingHead> head) : TwoFiles(std::move(views)), head_(std::move(head)) {}
  std::int64_t count() const override { return head_ ? head_->pairs : TwoFiles::count(); }
  std::optional<Rig> rig() const override { return head_ ? head_->rig : std::nullopt; }
  Result<std::uint64_t> pass_to(std::uint64_t number) override {
    // The index of a recording that was cut names pictures that are not there: its head tells.
    const bool whole = head_ && head_->pairs > 0 && number < static_cast<std::uint64_t>(head_->pairs);
    FileSource *l = as_file(views_.sources[0]), *r = as_file(views_.sources[1]);
    if (!whole || ended_ || !l->prepare_seek() || !r->prepare_seek()) return read_to(number, given_);
    for (FileSource* file : {l, r}) DUO_TRY(file->seek(static_cast<std::int64_t>(number)));
    given_ = number;
    return number;
  }
  Result<Next> next(Pair& into) override {
    if (ended_) return *ended_;
    DUO_TRY_ASSIGN(Next left_next, left().next(into.left));
    DUO_TRY_ASSIGN(Next right_next, right().next(into.right));
    const FileSource *l = as_file(views_.sources[0]), *r = as_file(views_.sources[1]);
    while (l != nullptr && r != nullptr && left_next == Next::kNew && right_next == Next::kNew && l->number() != r->number()) {
      const bool left_behind = l->number() < r->number();
      DUO_TRY_ASSIGN((left_behind ? left_next : right_next), left_behind ? left().next(into.left) : right().next(into.right));
    }
    into.sequence = given_;
    if (left_next != Next::kNew || right_next != Next::kNew) return end(left_next, right_next, {static_cast<std::int64_t>(given_), static_cast<std::int64_t>(given_)});
    ++given_;
    return Next::kNew;
  }

 private:
  std::optional<RecordingHead> head_;
  std::uint64_t given_ = 0;
};

class PairsByTime final : public TwoFiles {
 public:
  PairsByTime(TwoViews views, TimeNs skew_ns) : TwoFiles(std::move(views)), pairing_({left().frame_s(), right().frame_s()}) {
    FileSource *l = as_file(views_.sources[0]), *r = as_file(views_.sources[1]);
    if (l == nullptr || r == nullptr) return;
    const bool apart = (l->end_ns() > 0 && r->first_ns() + skew_ns > l->end_ns()) ||
                       (r->end_ns() > 0 && l->first_ns() > r->end_ns() + skew_ns);
    if (l->any_origin() != r->any_origin() || (apart && skew_ns == 0)) {
      if (apart) note("the times of both files have nothing in common: both are taken to begin together");
      l->shift_times(-l->first_ns());
      r->shift_times(-r->first_ns());
    }
    r->shift_times(skew_ns);
  }

  Result<Next> next(Pair& into) override {
    if (ended_) return *ended_;
    DUO_TRY_ASSIGN(const bool paired, next_pair(into));
    return paired ? Result<Next>(Next::kNew) : end_of_pairs();
  }

  /// By times alone, as next() pairs; then the pictures that wait are read.
  Result<std::uint64_t> pass_to(std::uint64_t number) override {
    for (std::size_t i = 0; i < 2 && !ended_; ++i)
      if (FileSource* const file = as_file(views_.sources[i]); file != nullptr) times_[i] = file->indexed_times();
    if (times_[0].empty() || times_[1].empty()) {
      times_ = {};
      return read_to(number, given_);
    }
    Pair passed;
    bool paired = true;
    while (given_ < number && paired) {
      DUO_TRY_ASSIGN(paired, next_pair(passed));
    }
    times_ = {};
    for (const CameraSide side : {CameraSide::kLeft, CameraSide::kRight}) DUO_TRY(read_waiting(side));
    return given_;
  }

 private:
  /// False at the end.
  Result<bool> next_pair(Pair& into) {
    while (true) {
      DUO_TRY(read_ahead(CameraSide::kLeft));
      DUO_TRY(read_ahead(CameraSide::kRight));
      if (pairing_.waiting(CameraSide::kLeft) == 0 || pairing_.waiting(CameraSide::kRight) == 0) return false;
      if (pairing_.step(into) != Pairing::Step::kPair) continue;
      ++given_;
      return true;
    }
  }

  /// As many of a side that the nearest one and the rate are known.
  Result<void> read_ahead(CameraSide side) {
    const auto i = static_cast<std::size_t>(side);
    while (ends_[i] == Next::kNew && pairing_.waiting(side) < kAhead) {
      const auto at = static_cast<std::size_t>(pairing_.put_so_far(side));
      if (times_[i].empty()) {
        DUO_TRY_ASSIGN(ends_[i], views_.sources[i]->next(picture_));
      } else if (at < times_[i].size()) {
        picture_.t_ns = times_[i][at];
      } else {
        ends_[i] = Next::kEnd;
      }
      if (ends_[i] == Next::kNew) pairing_.put(side, picture_);
    }
    return {};
  }

  /// The pictures of those that were put by their times alone.
  Result<void> read_waiting(CameraSide side) {
    Source& source = *views_.sources[static_cast<std::size_t>(side)];
    const auto waiting = static_cast<std::int64_t>(pairing_.waiting(side));
    if (waiting == 0) return {};
    const std::int64_t first = pairing_.put_so_far(side) - waiting;
    DUO_TRY(as_file(views_.sources[static_cast<std::size_t>(side)])->seek(first));
    for (std::int64_t i = 0; i < waiting; ++i) {
      DUO_TRY_ASSIGN(const Next next, source.next(picture_));
      if (next != Next::kNew || !pairing_.complete(side, static_cast<std::size_t>(i), picture_))
        return Error{ErrorCode::kBadInput,
                     fmt::format("cannot begin after pair {} of {}: picture {} there is damaged or has another time than the "
                                 "file's index says; begin some pairs earlier or later",
                                 given_, views_.names[static_cast<std::size_t>(side)], first + i)};
    }
    return {};
  }

  Result<Next> end_of_pairs() {
    if (given_ == 0 && ends_[0] != Next::kCut && ends_[1] != Next::kCut)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot pair {} with {}: no picture of one was taken when one of the other was; --skew-ms says "
                               "how much later the right ones were taken than their times say",
                               views_.names[0], views_.names[1])};
    std::array<std::int64_t, 2> alone{};
    std::array<Next, 2> ends = ends_;
    for (const CameraSide side : {CameraSide::kLeft, CameraSide::kRight}) {
      const auto i = static_cast<std::size_t>(side);
      const std::size_t waiting = pairing_.waiting(side);
      const bool goes_on = waiting > 1 && ends_[i] != Next::kCut;  // else it is one that came late
      if (goes_on) ends[i] = Next::kNew;
      alone[i] = pairing_.alone(side) + (goes_on ? 0 : static_cast<std::int64_t>(waiting));
    }
    if (alone[0] + alone[1] > 0)
      note(fmt::format("without a partner at its time, and left out: {} of {} left pictures, {} of {} right ones", alone[0],
                       pairing_.put_so_far(CameraSide::kLeft), alone[1], pairing_.put_so_far(CameraSide::kRight)));
    return end(ends[0], ends[1], {pairing_.put_so_far(CameraSide::kLeft), pairing_.put_so_far(CameraSide::kRight)});
  }

  static constexpr std::size_t kAhead = 4;
  Pairing pairing_;
  std::array<Next, 2> ends_ = {Next::kNew, Next::kNew};
  std::array<std::vector<TimeNs>, 2> times_;  // while pictures are passed over
  Picture picture_;
  std::uint64_t given_ = 0;
};

}  // namespace

std::unique_ptr<PairSource> pair_by_number(TwoViews views, std::optional<RecordingHead> head) {
  return std::make_unique<PairsByNumber>(std::move(views), std::move(head));
}

std::unique_ptr<PairSource> pair_by_time(TwoViews views, TimeNs skew_ns) {
  return std::make_unique<PairsByTime>(std::move(views), skew_ns);
}

}  // namespace duo
