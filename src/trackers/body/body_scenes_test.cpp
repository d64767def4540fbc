// The tracker body on made-up scenes: who walks in, a child, and what only looks like a person.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "trackers/body/joints.h"
#include "trackers/body/rendered_person.h"

namespace duo {
namespace {

using test::body_tracker, test::copy_of, test::kFrames, test::RenderedPerson;

constexpr std::uint16_t kWall_q4 = 180;

/// The rendered person alone: a pixel of it is nearer than the room, and not beside it.
struct Cutout {
  const Frame* frame;
  bool has(int x, int y) const {
    constexpr int kHalf_px = 70, kFrom_q4 = 235;
    const View<const std::uint16_t> d_q4 = frame->disparity.d_q4;
    if (x < 0 || y < 0 || x >= d_q4.width() || y >= d_q4.height() || std::abs(x - d_q4.width() / 2) > kHalf_px) return false;
    return d_q4.at(y, x) != Disparity::kNone && d_q4.at(y, x) > kFrom_q4;
  }
};

/// To and fro through the rendered frames.
std::size_t there(int i) {
  const int at = i % (2 * kFrames);
  return static_cast<std::size_t>(at < kFrames ? at : 2 * kFrames - 1 - at);
}

/// A mottled wall, 30 px of disparity farther than the person.
Frame wall() {
  Frame out = copy_of(*RenderedPerson::get().frames[0]);
  std::mt19937 random(7);
  for (int y = 0; y < out.color.height(); ++y)
    for (int x = 0; x < out.color.width(); ++x) {
      const auto shade = static_cast<std::uint8_t>(170 + random() % 24);
      out.color.at(y, x) = {shade, shade, static_cast<std::uint8_t>(shade - 14)};
      out.disparity.d_q4.at(y, x) = kWall_q4;
    }
  return out;
}

/// Draws over a frame: `from` says of a pixel which of the source it is, if it is one of the person's. `nearer`: times as large
/// disparities.
template <class From>
void draw_person(Frame& frame, int i, From from, double nearer = 1) {
  const Frame& source = *RenderedPerson::get().frames[there(i)];
  const Cutout person{&source};
  for (int y = 0; y < frame.color.height(); ++y)
    for (int x = 0; x < frame.color.width(); ++x) {
      const auto [from_x, from_y] = from(x, y);
      if (!person.has(from_x, from_y)) continue;
      frame.color.at(y, x) = source.color.at(from_y, from_x);
      frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(nearer * source.disparity.d_q4.at(from_y, from_x));
    }
}

void draw_box(Frame& frame, Window box, Rgb8 color, std::uint16_t q4) {
  for (int y = std::max(box.y, 0); y < std::min(box.y_end(), frame.color.height()); ++y)
    for (int x = std::max(box.x, 0); x < std::min(box.x_end(), frame.color.width()); ++x) {
      const auto grain = static_cast<std::uint8_t>((x * 7 + y * 5) % 11);
      frame.color.at(y, x) = {static_cast<std::uint8_t>(color.r + grain), static_cast<std::uint8_t>(color.g + grain),
                              static_cast<std::uint8_t>(color.b + grain)};
      frame.disparity.d_q4.at(y, x) = q4;
    }
}

Vec3 truth_of(JointId id, int i) {
  const RenderedPerson& person = RenderedPerson::get();
  for (const SyntheticJoint& joint : person.joints[there(i)])
    if (joint.id == id) return person.rectified.rig_from_left * joint.p_in_left_m;
  return {};
}

int seen_joints(std::span<const Person> people) {
  int count = 0;
  for (const Person& person : people)
    for (std::size_t j = 0; j < person.count(); ++j) count += person.joints[j].state == JointState::kSeen;
  return count;
}

/// What is seen of somebody lies where the truth is, which `moved` may have moved.
template <class Moved>
int expect_true(const Person& found, int i, double most_m, Moved moved) {
  int seen = 0;
  for (std::size_t j = 0; j < found.count(); ++j) {
    const JointId id = kBody.joints[j].id;
    if (found.joints[j].state != JointState::kSeen || id == JointId::kSpine || id == JointId::kChest) continue;
    ++seen;
    EXPECT_LT(norm(found.joints[j].p_in_rig_m - moved(truth_of(id, i))), most_m) << name_of(id) << " in frame " << i;
  }
  return seen;
}

// 57 mm a frame.
TEST(BodyScenes, OfWhomWalksInOnlyWhatIsInThePictureIsSeen) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr int kSteps = 30, kStep_px = 7;
  int seen = 0;
  for (int i = 0; i < kSteps; ++i) {
    const int right_px = (kSteps - 1 - i) * kStep_px;
    Frame frame = wall();
    draw_person(frame, i, [&](int x, int y) { return std::pair(x - right_px, y); });
    const auto people = tracker->track(frame);
    ASSERT_LE(people.size(), 1u) << i;
    if (people.empty()) continue;
    EXPECT_EQ(people[0].id, 1u) << i;
    seen = expect_true(people[0], i, 0.2, [&](Vec3 p) {
      const Vec2 at = person.rectified.project(p);
      return person.rectified.unproject({at.x + right_px, at.y}, p.z);
    });
    for (std::size_t j = 0; j < people[0].count(); ++j) {
      if (people[0].joints[j].state == JointState::kSeen) {
        EXPECT_LT(person.rectified.project(people[0].joints[j].p_in_rig_m).x, person.rectified.size.width + 4) << i;
      }
    }
  }
  EXPECT_GT(seen, 12);
}

// Somebody 60 cm nearer stands beside, so that the boxes around both overlap; nobody covers the other.
TEST(BodyScenes, WhoComesLaterBesideSomebodyNearerIsSeenSoon) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr double kNearer = 1.45;
  constexpr int kSteps = 30, kComes = 4, kAside_px = 42;
  int frames = 0, seen_in = 0;
  for (int i = 0; i < kSteps; ++i) {
    Frame frame = wall(), nearer = wall();
    if (i >= kComes) draw_person(frame, i, [&](int x, int y) { return std::pair(x - kAside_px, y); });
    draw_person(nearer, i, [&](int x, int y) { return std::pair(x + kAside_px, y); });
    for (int y = 0; y < frame.color.height(); ++y)
      for (int x = 0; x < frame.color.width(); ++x) {
        const std::uint16_t q4 = nearer.disparity.d_q4.at(y, x);
        if (q4 == kWall_q4) continue;
        frame.color.at(y, x) = nearer.color.at(y, x);
        frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(kNearer * q4);
      }
    const auto people = tracker->track(frame);
    ASSERT_LE(people.size(), 2u) << i;
    if (people.size() < 2) continue;
    ++frames;
    EXPECT_EQ(people[1].id, 2u);
    const int seen = seen_joints(people.last(1));
    if (frames < 3) {
      EXPECT_EQ(seen, 0) << i;
    }
    seen_in += seen > 8;
  }
  EXPECT_GT(frames, 10);
  EXPECT_GE(seen_in, frames - 4);
}

/// Depth was looked for in a part of the frame alone.
void match_only(Frame& frame, Window part) {
  frame.matched = part;
  for (int y = 0; y < frame.disparity.d_q4.height(); ++y)
    for (int x = 0; x < frame.disparity.d_q4.width(); ++x)
      if (!part.contains(y, x)) frame.disparity.d_q4.at(y, x) = Disparity::kNone;
}

// Whoever is found in a frame that was matched as a whole has no depth in the two after it, which are matched around the other
// one alone. They say nothing against it.
TEST(BodyScenes, WhoIsFoundBesideSomebodyStaysWhereDepthIsNotYetLookedFor) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr int kSteps = 30, kComes = 2, kAside_px = 75, kAlone = 2;
  const Size size = person.rectified.size;
  int after = -1;  // frames since it was found
  for (int i = 0; i < kSteps; ++i) {
    Frame frame = wall();
    draw_person(frame, i, [&](int x, int y) { return std::pair(x + kAside_px, y); });
    if (i >= kComes) draw_person(frame, i, [&](int x, int y) { return std::pair(x - kAside_px, y); });
    if (after >= 0 && after < kAlone) match_only(frame, {0, 0, size.width / 2, size.height});
    const auto people = tracker->track(frame);
    if (after >= 0 || people.size() > 1) ++after;
    if (after < 0) continue;
    ASSERT_EQ(people.size(), 2u) << i;
    EXPECT_EQ(people[1].id, 2u) << i;
    const bool is_seen = seen_joints(people.last(1)) > 8;
    EXPECT_TRUE(after != kAlone || !is_seen) << i;
    EXPECT_TRUE(after < kAlone + 3 || is_seen) << i;
  }
  EXPECT_GT(after, 12);
}

// A mirror shows somebody behind the wall, who is as much smaller as farther away and does the same with the other hand.
TEST(BodyScenes, BesideAMirrorThereAreTwoAndEachKeepsItsNumber) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr int kSteps = 30, kAside_px = 75;
  constexpr double kFarther = 0.7;
  const Size size = person.rectified.size;
  int both = 0;
  for (int i = 0; i < kSteps; ++i) {
    Frame frame = wall();
    draw_box(frame, Window::all(size), {150, 150, 140}, 100);
    draw_person(
        frame, i,
        [&](int x, int y) {
          return std::pair(static_cast<int>(size.width / 2 - (x - size.width / 2 - kAside_px) / kFarther),
                           static_cast<int>(size.height / 2 + (y - size.height / 2) / kFarther));
        },
        kFarther);
    draw_person(frame, i, [&](int x, int y) { return std::pair(x + kAside_px, y); });
    const auto people = tracker->track(frame);
    ASSERT_LE(people.size(), 2u);
    for (const Person& found : people) EXPECT_LE(found.id, 2u) << i;
    if (people.size() < 2) continue;
    both += seen_joints(people.first(1)) > 8 && seen_joints(people.last(1)) > 8;
    const double apart_m = people[0].find(JointId::kPelvis)->p_in_rig_m.z - people[1].find(JointId::kPelvis)->p_in_rig_m.z;
    EXPECT_GT(std::abs(apart_m), 0.6) << i;
  }
  EXPECT_GT(both, kSteps / 2);
}

// Four rows of five, half as large and twice as far away; who stands before covers the legs of who stands behind.
TEST(BodyScenes, OfTwentyPeopleEightAreFollowedAtMostAndEachIsOne) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr int kSteps = 30, kRows = 4, kColumn_px = 64, kRow_px = 36, kSmaller = 2;
  constexpr double kNear_px = 10;
  const Size size = person.rectified.size;
  std::size_t most = 0;
  int seen = 0;
  for (int i = 0; i < kSteps; ++i) {
    Frame frame = wall();
    draw_box(frame, Window::all(size), {150, 150, 140}, 90);
    for (int row = 0; row < kRows; ++row)
      draw_person(
          frame, i,
          [&](int x, int y) {
            return std::pair(size.width / 2 + kSmaller * (x % kColumn_px - kColumn_px / 2), kSmaller * (y - row * kRow_px));
          },
          (1 + 0.1 * row) / kSmaller);
    const auto people = tracker->track(frame);
    ASSERT_LE(people.size(), 8u);
    most = std::max(most, people.size());
    for (const Person& found : people)
      for (const JointId id : {JointId::kHead, JointId::kLeftShoulder, JointId::kRightShoulder}) {
        const Joint& joint = *found.find(id);
        if (joint.state != JointState::kSeen) continue;
        ++seen;
        const double at_px = person.rectified.project(joint.p_in_rig_m).x,
                     truth_px = person.rectified.project(truth_of(id, i)).x;
        const double off_px = at_px - (truth_px - size.width / 2) / kSmaller - kColumn_px / 2;
        EXPECT_LT(std::abs(std::remainder(off_px, kColumn_px)), kNear_px) << name_of(id) << " in frame " << i;
      }
  }
  EXPECT_GT(most, 2u);
  EXPECT_GT(seen, 100);
}

// From two metres to half a metre, until the picture shows little more than a face.
TEST(BodyScenes, OfWhomComesNearOnlyWhatIsInThePictureIsSeen) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr int kSteps = 48;
  constexpr double kNearest = 4;
  const Size size = person.rectified.size;
  const double row_px = person.rectified.project(truth_of(JointId::kLeftShoulder, 0)).y;
  int seen_near = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double nearer = 1 / (1 - (1 - 1 / kNearest) * i / (kSteps - 1));
    Frame frame = wall();
    draw_person(
        frame, i,
        [&](int x, int y) {
          return std::pair(static_cast<int>(size.width / 2 + (x - size.width / 2) / nearer),
                           static_cast<int>(row_px + (y - row_px) / nearer));
        },
        nearer);
    const auto people = tracker->track(frame);
    ASSERT_LE(people.size(), 1u) << i;
    for (const Person& found : people)
      for (std::size_t j = 0; j < found.count(); ++j) {
        if (found.joints[j].state != JointState::kSeen) continue;
        const Vec3 p = found.joints[j].p_in_rig_m;
        const Vec2 at = person.rectified.project(p);
        seen_near += nearer > 2;
        EXPECT_NEAR(p.z, truth_of(JointId::kHead, i).z / nearer, 0.4) << name_of(kBody.joints[j].id) << " in frame " << i;
        EXPECT_TRUE(at.x > -25 && at.y > -25 && at.x < size.width + 25 && at.y < size.height + 25)
            << name_of(kBody.joints[j].id) << " at " << at.x << " " << at.y << " in frame " << i;
      }
  }
  EXPECT_GT(seen_near, 20);
}

// 1.05 m high where the adult stands.
TEST(BodyScenes, AChildIsAPerson) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr double kScale = 0.6;
  const Size size = person.rectified.size;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = wall();
    draw_person(frame, i, [&](int x, int y) {
      return std::pair(static_cast<int>(size.width / 2 + (x - size.width / 2) / kScale),
                       static_cast<int>(size.height + (y - size.height) / kScale));
    });
    const auto people = tracker->track(frame);
    ASSERT_EQ(people.size(), 1u) << i;
    EXPECT_EQ(people[0].id, 1u);
    const int seen = expect_true(people[0], i, 0.2, [&](Vec3 p) {
      const Vec2 at = person.rectified.project(p);
      return person.rectified.unproject(
          {size.width / 2 + kScale * (at.x - size.width / 2), size.height + kScale * (at.y - size.height)}, p.z);
    });
    if (i > 2) {
      EXPECT_GT(seen, 9) << i;
    }
  }
}

// A coat with sleeves and no head on a pole, two metres away.
TEST(BodyScenes, ACoatOnAStandIsNoPerson) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < 9; ++i) {
    Frame frame = wall();
    draw_box(frame, {158, 30, 4, 200}, {60, 40, 20}, 280);
    draw_box(frame, {140, 226, 40, 6}, {60, 40, 20}, 280);
    for (int k = 0; k < 20; ++k) draw_box(frame, {141 - k / 2, 60 + 5 * k, 38 + k, 5}, {30, 40, 80}, 284);
    for (int k = 0; k < 14; ++k) {
      draw_box(frame, {133 - k / 2, 66 + 5 * k, 11, 5}, {24, 34, 70}, 282);
      draw_box(frame, {176 + k / 2, 66 + 5 * k, 11, 5}, {24, 34, 70}, 282);
    }
    EXPECT_EQ(seen_joints(tracker->track(frame)), 0) << i;
  }
}

// The upper half of somebody, on a television 40 cm before the wall.
TEST(BodyScenes, SomebodyOnATelevisionIsNoPerson) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < 12; ++i) {
    const Frame& source = *person.frames[there(i)];
    Frame frame = wall();
    const Window screen = {70, 50, 180, 110};
    for (int y = screen.y; y < screen.y_end(); ++y)
      for (int x = screen.x; x < screen.x_end(); ++x) {
        const bool border = x < screen.x + 4 || y < screen.y + 4 || x >= screen.x_end() - 4 || y >= screen.y_end() - 4;
        frame.color.at(y, x) = border ? Rgb8{15, 15, 18} : source.color.at(y - screen.y + 20, x);
        frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(215 + (x * 7 + y * 3) % 3);
      }
    EXPECT_EQ(seen_joints(tracker->track(frame)), 0) << i;
  }
}

// A telephone that shows the person's own head and shoulders, beside its hand.
TEST(BodyScenes, AFaceOnATelephoneIsNobodyElse) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < kFrames; ++i) {
    const Frame& source = *person.frames[there(i)];
    Frame frame = copy_of(source);
    const Vec2 hand = person.rectified.project(truth_of(JointId::kLeftHand, i)),
               head = person.rectified.project(truth_of(JointId::kHead, i));
    const std::uint16_t q4 = static_cast<std::uint16_t>(16 * person.rectified.focal_px * person.rectified.baseline_m /
                                                        (truth_of(JointId::kLeftHand, i).z - 0.05));
    constexpr int kHalf_px = 14, kShrunk = 3;
    for (int y = -2 * kHalf_px; y < 2 * kHalf_px; ++y)
      for (int x = -kHalf_px; x < kHalf_px; ++x) {
        const int to_x = static_cast<int>(hand.x) + x, to_y = static_cast<int>(hand.y) + y;
        const int from_x = static_cast<int>(head.x) + kShrunk * x, from_y = static_cast<int>(head.y) + kShrunk * (y + kHalf_px);
        if (to_x < 0 || to_y < 0 || to_x >= frame.color.width() || to_y >= frame.color.height()) continue;
        if (from_x < 0 || from_y < 0 || from_x >= frame.color.width() || from_y >= frame.color.height()) continue;
        frame.color.at(to_y, to_x) = source.color.at(from_y, from_x);
        frame.disparity.d_q4.at(to_y, to_x) = q4;
      }
    EXPECT_EQ(tracker->track(frame).size(), 1u) << i;
  }
}

}  // namespace
}  // namespace duo
