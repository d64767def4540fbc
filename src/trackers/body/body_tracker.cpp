#include "trackers/body/body_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/clock.h"
#include "core/lens.h"
#include "detectors/small_hands.h"
#include "duoptic/detector.h"
#include "trackers/body/body.h"
#include "trackers/body/filled_margin.h"
#include "trackers/body/fingers.h"
#include "trackers/body/newcomers.h"
#include "trackers/body/trial.h"
#include "trackers/body/uncover.h"

namespace duo {
namespace {

using body::Body;
using body::Fingers;
using body::Uncover;

constexpr std::size_t kMostPeople = 8;
constexpr int kSearchEvery = 8;                    // frames
constexpr double kAlike = 1, kPerhapsAlike = 2.2;  // Body::unlike() below which two are the same person

class BodyTracker final : public Tracker {
 public:
  /// `skeleton`: kBody or kBodyHands.
  BodyTracker(const char* name, const Skeleton& skeleton) : name_(name), skeletons_{&skeleton} {}
  const char* name() const override { return name_; }
  std::span<const Skeleton* const> skeletons() const override { return skeletons_; }
  bool starts_by_itself() const override { return true; }
  Wants wants() const override { return {.color = true}; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<std::span<const Person>> select(const Frame& frame, std::span<const Selection> selections) override;
  std::span<const Person> track(const Frame& frame) override;
  void reset() override;
  std::span<const StageTime> stages() const override { return times_; }

 private:
  struct Tracked {
    std::uint32_t id = 0;
    Body body;
    bool matched = false;        // with one whom the finder sees
    Uncover* uncover = nullptr;  // while somebody is before or behind this person
    bool covered = false;        // somebody is before
    body::Trial trial = {};
    bool came_later = false;  // not in the first frame
    std::array<Fingers, 2> fingers = {Fingers(true), Fingers(false)};
  };
  /// A tracked person as this frame shows it.
  struct Sight {
    Tracked* who = nullptr;
    const SeenBody* seen = nullptr;
    const body::FrameView* frame = nullptr;
    std::array<std::optional<std::size_t>, 2> hands = {};  // left, right: which of those looked at
  };
  /// From the last frame to this one: by the frames' times a multiple of what the setup says, as frames may have been left out.
  double time_since_last(const Frame& frame);
  /// Of people who overlap, takes the others out of the frame that each is looked for in.
  void uncover(const body::FrameView& frame);
  /// Finds the tracked person that each seen one is, the most alike first.
  void match(const body::FrameView& frame, std::span<const SeenPerson> seen);
  void match(const body::FrameView& frame, std::span<const SeenPerson> seen, double most);
  /// Those whom the finder sees; those who overlap with others are looked at in frames of their own.
  void gather(const body::FrameView& frame, std::span<const SeenPerson> seen);
  /// Whether a body that nobody owns lies over one that somebody does: the same person, marked twice.
  bool is_of_another(const body::FrameView& frame, std::span<const SeenPerson> seen, std::size_t which) const;
  /// Adds where to look for those who are not followed: who was missed, and in a frame that was matched as a whole who is new.
  void look_elsewhere(const body::FrameView& frame, bool whole);
  void look_at_hands();
  /// Drops those who are gone, and who was taken for somebody by mistake.
  void forget();
  void track_fingers(Tracked& who, const body::FrameView& frame);
  void publish(const body::FrameView& frame);

  bool has_fingers() const { return skeletons_[0] == &kBodyHands; }

  const char* name_;
  std::array<const Skeleton*, 1> skeletons_;
  std::optional<Lens> lens_;  // empty before prepare()
  body::FilledMargin margin_;
  TrackerSetup setup_;
  std::unique_ptr<Detector> detector_;
  std::unique_ptr<PeopleFinder> finder_;
  std::vector<Tracked> tracked_;
  std::vector<Tracked*> owners_;       // of each person seen
  std::vector<Sight> sights_;          // the nearest first
  std::vector<TurnedSquare> regions_;  // of those whom the finder does not follow
  body::Newcomers newcomers_;
  std::vector<Vec3> trunks_;
  std::vector<const body::Places*> nearer_;
  std::array<Uncover, kMostPeople> uncovers_;
  std::array<SeenBody, kMostPeople> alone_;  // those who overlap with others
  std::vector<Look> looks_;
  std::vector<SeenHand> hands_;
  std::vector<Person> people_;
  StageTimer timer_;
  StageTimer::Times times_{};
  std::uint32_t next_id_ = 1;                 // goes on after reset(): files and receivers know persons by it
  std::int64_t frame_ = 0, next_search_ = 0;  // for those who are new
  TimeNs last_ns_ = 0;                        // the time of the last frame,
  double last_step_s_ = 0;                    // and that from the one before to it
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
  margin_ = body::FilledMargin(setup.rectified, *lens_);
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
  sights_.reserve(kMostPeople);
  nearer_.reserve(kMostPeople);
  regions_.reserve(kMostPeople + 1);
  trunks_.reserve(kMostPeople);
  owners_.reserve(kMostPeople);
  looks_.reserve(2 * kMostPeople);  // hands
  hands_.reserve(2 * kMostPeople);
  newcomers_ = {};
  if (detector_)
    finder_ = std::make_unique<PeopleFinder>(
        *detector_, PeopleFinder::Options{.hands = false, .most = kMostPeople, .search_every = kSearchEvery});
  frame_ = next_search_ = 0;
  last_step_s_ = setup_.frame_s;
}

void BodyTracker::match(const body::FrameView& frame, std::span<const SeenPerson> seen) {
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

bool BodyTracker::is_of_another(const body::FrameView& frame, std::span<const SeenPerson> seen, std::size_t which) const {
  constexpr double kMost = 0.6;      // of the smaller box
  constexpr double kApart_m = 0.25;  // who is nearer or farther is somebody else
  const Window& box = seen[which].box_px;
  const double z_m = body::trunk_depth(frame.depth, body::corners_of(seen[which].body), body::kAnyDepth);
  const auto lies_over = [&](const Window& other, const Tracked& owner) {
    const double width = std::min(box.x_end(), other.x_end()) - std::max(box.x, other.x);
    const double height = std::min(box.y_end(), other.y_end()) - std::max(box.y, other.y);
    const double least = std::min(double(box.width) * box.height, double(other.width) * other.height);
    return width > 0 && height > 0 && width * height > kMost * least && std::abs(owner.body.trunk_z_m() - z_m) < kApart_m;
  };
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (i != which && owners_[i] != nullptr && lies_over(seen[i].box_px, *owners_[i])) return true;
  return std::ranges::any_of(tracked_, [&](const Tracked& each) {
    return each.uncover != nullptr && lies_over(each.body.expected_box(frame).within(frame.picture.size()), each);
  });
}

void BodyTracker::uncover(const body::FrameView& frame) {
  constexpr double kApart_m = 0.25;
  constexpr double kStillThere = 5;  // ticks
  std::size_t used = 0;
  for (Tracked& each : tracked_) {
    each.uncover = nullptr;
    each.covered = false;
    const Window box = each.body.expected_box(frame);
    const double z_m = each.body.expected_trunk().z;
    for (const Tracked& other : tracked_) {
      const double other_z_m = other.body.expected_trunk().z;
      if (&other == &each || other.body.missed() > kStillThere || std::abs(other_z_m - z_m) < kApart_m) continue;
      const Window beside = other.body.expected_box(frame);
      // Who is not followed is looked for in a region that the other one may fill.
      const int around = each.matched ? 0 : box.height / 2;
      if (std::min(box.x_end(), beside.x_end()) + around < std::max(box.x, beside.x)) continue;
      if (std::min(box.y_end(), beside.y_end()) < std::max(box.y, beside.y)) continue;
      if (each.uncover == nullptr) {
        each.uncover = &uncovers_[used++];
        each.uncover->begin(frame, each.body.trunk_z_m());
      }
      const double between_m = (z_m + other_z_m) / 2;
      if (other_z_m < z_m)
        each.uncover->take_out_before(beside, between_m);
      else
        each.uncover->take_out_behind(beside, between_m);
      each.covered = each.covered || other_z_m < z_m;
    }
    if (each.uncover != nullptr) each.uncover->finish();
  }
}

void BodyTracker::gather(const body::FrameView& frame, std::span<const SeenPerson> seen) {
  constexpr std::uint16_t kThere = 16384;  // a probability of 0.5
  constexpr double kMostCovered = 0.85;
  sights_.clear();
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (owners_[i] != nullptr && owners_[i]->uncover == nullptr) sights_.push_back({owners_[i], &seen[i].body, &frame, {}});
  std::size_t used = 0;
  for (Tracked& each : tracked_) {
    if (each.uncover == nullptr) continue;
    const body::FrameView& uncovered = each.uncover->view();
    SeenBody& alone = alone_[used++];
    const Look look = {uncovered.picture, each.body.expected_region(frame)};
    detector_->bodies({&look, 1}, {&alone, 1});
    const auto plain = std::ranges::find(owners_, &each);
    if (alone.score_q15 >= kThere && body::covered_share(uncovered, body::corners_of(alone)) < kMostCovered &&
        each.body.unlike(uncovered, alone) < kPerhapsAlike)
      sights_.push_back({&each, &alone, &uncovered, {}});
    else if (plain != owners_.end() && !each.covered)
      sights_.push_back({&each, &seen[static_cast<std::size_t>(plain - owners_.begin())].body, &uncovered, {}});
  }
  std::ranges::sort(sights_, {}, [](const Sight& s) { return std::pair(s.who->body.expected_trunk().z, s.who->id); });
}

void BodyTracker::look_elsewhere(const body::FrameView& frame, bool whole) {
  regions_.clear();
  for (const Tracked& each : tracked_)
    if (!each.matched && each.uncover == nullptr) regions_.push_back(each.body.expected_region(frame));
  if (!whole || frame_ < next_search_ || tracked_.size() == kMostPeople) return;
  next_search_ = frame_ + (frame_ < kSearchEvery / 2 ? 1 : kSearchEvery);
  constexpr double kStillThere = 3;  // ticks
  trunks_.clear();
  for (const Tracked& each : tracked_)
    if (each.body.missed() <= kStillThere) trunks_.push_back(each.body.expected_trunk());
  if (const auto region = newcomers_.look(*detector_, frame, trunks_)) regions_.push_back(*region);
}

void BodyTracker::look_at_hands() {
  looks_.clear();
  const bool turn = frame_ % 2 == 0;
  for (const bool left : {true, false}) {
    if (left != turn && !has_fingers()) continue;  // the other hand in the next frame
    for (Sight& sight : sights_)
      if (const auto region = sight.who->body.hand_region(*sight.frame, *sight.seen, left)) {
        sight.hands[left ? 0 : 1] = looks_.size();
        looks_.push_back({sight.frame->picture, *region});
      }
  }
  hands_.resize(looks_.size());
  detector_->hands(looks_, hands_);
}

double BodyTracker::time_since_last(const Frame& frame) {
  constexpr double kMost_s = 0.99;
  constexpr double kJitter = 0.25;  // of a frame: what is as near to whole frames is whole frames
  double frames = frame_ == 0 ? 1 : static_cast<double>(frame.t_ns - last_ns_) * 1e-9 / setup_.frame_s;
  if (std::abs(frames - std::round(frames)) < kJitter) frames = std::round(frames);
  const double step_s = setup_.frame_s * std::clamp(frames, 1.0, std::max(std::floor(kMost_s / setup_.frame_s), 1.0));
  if (step_s != last_step_s_)
    for (Tracked& each : tracked_) each.body.stretch_step(step_s / last_step_s_);
  last_ns_ = frame.t_ns;
  last_step_s_ = step_s;
  return step_s;
}

std::span<const Person> BodyTracker::track(const Frame& frame) {
  DUO_CHECK(finder_ != nullptr);
  timer_.start(times_, setup_.time_stages);
  const View<const Rgb8> picture = margin_.fill(frame.color);
  const body::FrameView view{{frame.disparity.d_q4, &setup_.rectified},
                             picture,
                             time_since_last(frame),
                             setup_.body_model,
                             {},
                             margin_.mask(),
                             frame.matched};
  uncover(view);
  timer_.stage("fit");
  look_elsewhere(view, frame.matched.empty());
  const std::span<const SeenPerson> seen = finder_->follow(picture, regions_);
  timer_.stage("bodies");
  match(view, seen);
  for (std::size_t i = 0; i < seen.size() && tracked_.size() < kMostPeople; ++i) {
    if (owners_[i] != nullptr || is_of_another(view, seen, i)) continue;
    if (auto started = Body::start(view, seen[i].body); started && !newcomers_.was_mistaken(started->expected_trunk())) {
      tracked_.push_back({next_id_++, std::move(*started), true, nullptr, false, {}, frame_ > 0});
      owners_[i] = &tracked_.back();
    }
  }
  timer_.stage("fit");
  gather(view, seen);
  timer_.stage("bodies");
  look_at_hands();
  timer_.stage("hands");
  nearer_.clear();  // the nearest first: what is behind them is theirs to hide
  for (const Sight& sight : sights_) {
    Body::Hands hands;
    for (std::size_t s = 0; s < 2; ++s)
      if (sight.hands[s]) hands.seen[s] = &hands_[*sight.hands[s]];
    sight.who->body.track(*sight.frame, *sight.seen, hands, nearer_);
    nearer_.push_back(&sight.who->body.places());
    track_fingers(*sight.who, *sight.frame);
  }
  for (Tracked& each : tracked_)
    if (std::ranges::none_of(sights_, [&](const Sight& sight) { return sight.who == &each; })) {
      each.body.miss(view, each.covered);
      track_fingers(each, view);
    }
  forget();
  publish(view);
  timer_.stage("fit");
  ++frame_;
  return people_;
}

void BodyTracker::forget() {
  constexpr double kForget = 75, kForgetNew = 15;  // ticks
  std::erase_if(tracked_, [&](Tracked& each) {
    const double missed = each.body.missed();
    if (each.trial.is_over()) return missed > kForget;
    each.trial.add(each.body.seen_share(), each.body.is_flat() && !each.covered, body::ticks_in(setup_.frame_s));
    if (!each.trial.is_mistake()) return missed > (each.covered ? kForget : kForgetNew);
    newcomers_.add_mistake(each.body.expected_trunk());
    return true;
  });
}

void BodyTracker::track_fingers(Tracked& who, const body::FrameView& frame) {
  if (!has_fingers()) return;
  for (const bool left : {true, false}) who.fingers[left ? 0 : 1].track(frame, who.body.shown_hand(left), who.body.places());
}

void BodyTracker::publish(const body::FrameView& frame) {
  people_.clear();
  const Mat3 left_from_rig = transposed(setup_.rectified.rig_from_left);
  for (const Tracked& each : tracked_) {
    Person& person = people_.emplace_back();
    person.id = each.id;
    person.skeleton = skeletons_[0];
    each.body.publish(frame, person);
    if (has_fingers())
      for (const Fingers& fingers : each.fingers) fingers.publish(person);
    for (std::size_t j = 0; j < person.count(); ++j) {
      Joint& joint = person.joints[j];
      if (const auto pixel = lens_->pixel_of(left_from_rig * joint.p_in_rig_m)) {
        joint.u_px = pixel->x;
        joint.v_px = pixel->y;
      }
      // Of what is no person most is dropped before it is believed.
      if (each.came_later && !each.trial.is_believed() && joint.state == JointState::kSeen) joint.state = JointState::kInferred;
    }
    person.sum_up();
  }
}

}  // namespace

std::unique_ptr<Tracker> make_body_tracker() { return std::make_unique<BodyTracker>("body", kBody); }
std::unique_ptr<Tracker> make_body_hands_tracker() { return std::make_unique<BodyTracker>("body_hands", kBodyHands); }

}  // namespace duo
