// What other programs receive while it happens: OSC through liblo's own server; and sinks that are slow.
#include <gtest/gtest.h>
#include <lo/lo.h>

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>

#include "body/bone_turns.h"
#include "duoptic/sink.h"
#include "tests/arm_poses.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the poses

struct Message {
  std::string path, types;
  std::vector<std::string> words;
  std::vector<double> numbers;
};

/// liblo's own server on a port of 127.0.0.1 that was free.
class Receiver {
 public:
  Receiver() : server_(lo_server_new(nullptr, nullptr)) { lo_server_add_method(server_, nullptr, nullptr, &take, this); }
  ~Receiver() { lo_server_free(server_); }
  std::string target() const { return "127.0.0.1:" + std::to_string(lo_server_get_port(server_)); }
  /// The messages of the next bundle.
  std::vector<Message> next() {
    messages_.clear();
    lo_server_recv_noblock(server_, 2000);
    return std::move(messages_);
  }

 private:
  template <class T>
  static T value(const char* bytes) {
    T out;
    std::memcpy(&out, bytes, sizeof out);
    return out;
  }
  static int take(const char* path, const char* types, lo_arg** argv, int argc, lo_message, void* self) {
    Message& m = static_cast<Receiver*>(self)->messages_.emplace_back();
    m.path = path;
    m.types = types;
    for (int i = 0; i < argc; ++i) {
      // Arguments lie on four bytes, lo_arg would want eight.
      const char* bytes = reinterpret_cast<const char*>(argv[i]);
      if (types[i] == 's') m.words.emplace_back(bytes);
      if (types[i] == 'f') m.numbers.push_back(static_cast<double>(value<float>(bytes)));
      if (types[i] == 'i') m.numbers.push_back(value<std::int32_t>(bytes));
    }
    return 0;
  }
  lo_server server_;
  std::vector<Message> messages_;
};

TEST(Osc, AddressesAndValues) {
  Receiver receiver;
  auto sink = make_osc(receiver.target(), Axes::kUnity);
  ASSERT_TRUE(sink) << sink.error().what;
  Instant instant;
  instant.people = {arm_of({0.1, -0.25, 1.5}, {0, 0, 2}, {1, 2, 3}), person_with(kLeftArm, 2)};
  instant.people[0].joints[kElbow].state = JointState::kInferred;
  ASSERT_TRUE((*sink)->write(instant.tracked(57)));
  const auto got = receiver.next();
  std::map<std::string, Message> by_path;
  for (const Message& m : got) by_path[m.path] = m;
  EXPECT_EQ(got.size(), 1u + 6 + 3);  // lost joints have a state and no place
  ASSERT_EQ(by_path["/duoptic/frame"].types, "if");
  EXPECT_EQ(by_path["/duoptic/frame"].numbers[0], 57);
  EXPECT_NEAR(by_path["/duoptic/frame"].numbers[1], 1.9, 1e-6);
  ASSERT_EQ(by_path["/duoptic/person/1/right_hand"].types, "fff");
  EXPECT_EQ(by_path["/duoptic/person/1/right_hand"].numbers, (std::vector<double>{1, -2, 3}));
  ASSERT_EQ(by_path["/duoptic/person/1/right_hand/state"].types, "iff");
  EXPECT_EQ(by_path["/duoptic/person/1/right_hand/state"].numbers[0], 2);
  EXPECT_NEAR(by_path["/duoptic/person/1/right_hand/state"].numbers[1], 0.0125, 1e-6);
  EXPECT_EQ(by_path["/duoptic/person/1/right_elbow/state"].numbers[0], 1);
  EXPECT_EQ(by_path["/duoptic/person/2/left_shoulder/state"].numbers[0], 0);
  EXPECT_EQ(by_path.count("/duoptic/person/2/left_shoulder"), 0u);
}

/// With fingers a pinch is sent where it is known. Eight such people take more than a datagram holds: each packet begins with
/// the frame's number, and no person is cut.
TEST(Osc, FingersOfManyPeople) {
  Receiver receiver;
  auto sink = make_osc(receiver.target(), Axes::kOpencv);
  ASSERT_TRUE(sink) << sink.error().what;
  Instant instant;
  for (std::uint32_t id = 1; id <= 8; ++id) {
    instant.people.push_back(person_with(kBodyHands, id));
    for (std::size_t j = 0; j < kJointIds; ++j) instant.people.back().joints[j] = joint({0.001 * static_cast<double>(j), 0, 2});
  }
  instant.people[0].joints[static_cast<std::size_t>(JointId::kRightIndexTip)].state = JointState::kLost;
  ASSERT_TRUE((*sink)->write(instant.tracked(7)));
  EXPECT_EQ((*sink)->dropped(), 0);
  std::map<std::string, Message> by_path;
  int packets = 0;
  while (by_path.count("/duoptic/person/8/right_pinch") == 0) {
    const auto got = receiver.next();
    ASSERT_FALSE(got.empty()) << "after " << packets << " packets";
    ++packets;
    EXPECT_EQ(got[0].path, "/duoptic/frame");
    EXPECT_EQ(got[0].numbers[0], 7);
    const std::string last = got.back().path;
    EXPECT_EQ(last.substr(last.rfind('/')), "/right_pinch") << "a person's last message";
    for (const Message& m : got) by_path[m.path] = m;
  }
  EXPECT_GT(packets, 1);
  EXPECT_EQ(by_path.size(), 1u + 8 * (2 * kJointIds + 2) - 2);  // a place and a pinch are missing
  ASSERT_EQ(by_path["/duoptic/person/1/left_pinch"].types, "ff");
  EXPECT_NEAR(by_path["/duoptic/person/1/left_pinch"].numbers[0], 0.004, 1e-6);  // the tips' numbers differ by four
  EXPECT_NEAR(by_path["/duoptic/person/1/left_pinch"].numbers[1], 0.0125 * std::sqrt(2.0 / 3), 1e-6);
  EXPECT_EQ(by_path.count("/duoptic/person/1/right_pinch"), 0u);
}

/// A quaternion x y z w turns a vector: the formula itself, in any axes.
Vec3 turned(const std::vector<double>& n, Vec3 v) {
  const Vec3 q{n[3], n[4], n[5]};
  const Vec3 t = 2.0 * cross(q, v);
  return v + n[6] * t + cross(q, t);
}

TEST(Vmc, ARealReceiverGetsTheBones) {
  for (const Skeleton* skeleton : {&kRightArm, &kLeftArm}) {
    SCOPED_TRACE(skeleton->name);
    const bool left = skeleton == &kLeftArm;
    Receiver receiver;
    auto sink = make_vmc(receiver.target());
    ASSERT_TRUE(sink) << sink.error().what;
    const std::string name = left ? "Left" : "Right";
    const Vec3 rest{left ? -1.0 : 1.0, 0, 0};  // Unity: the avatar looks along z, its left is -x
    int number = 0;
    for (const Person& arm : wandering_arm(100, 4, *skeleton)) {
      Instant instant;
      instant.people = {arm};
      ASSERT_TRUE((*sink)->write(instant.tracked(number++)));
      const auto got = receiver.next();
      ASSERT_EQ(got.size(), 6u);
      EXPECT_EQ(got[0].path + got[0].types, "/VMC/Ext/OKi");
      EXPECT_EQ(got[0].numbers[0], 1);
      EXPECT_EQ(got[1].path + got[1].types, "/VMC/Ext/Tf");
      EXPECT_EQ(got[2].path + got[2].types + got[2].words[0], "/VMC/Ext/Root/Possfffffffroot");
      const std::string bones[] = {name + "UpperArm", name + "LowerArm", name + "Hand"};
      for (std::size_t b = 0; b < 3; ++b) {
        const Message& m = got[3 + b];
        ASSERT_EQ(m.path + m.types, "/VMC/Ext/Bone/Possfffffff");
        EXPECT_EQ(m.words[0], bones[b]);
        const auto& n = m.numbers;
        EXPECT_NEAR(n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6], 1, 1e-5);
      }
      // The person's front is the camera's back, up is minus y, and left and right are as the person has them.
      const auto avatar = [](Vec3 v) { return Vec3{-v.x, -v.y, -v.z}; };
      const auto &upper = got[3].numbers, &lower = got[4].numbers, &hand = got[5].numbers;
      const Vec3 to_elbow = turned(upper, {lower[0], lower[1], lower[2]});
      const Vec3 to_hand = turned(upper, turned(lower, {hand[0], hand[1], hand[2]}));
      EXPECT_LT(norm(to_elbow - avatar(arm.joints[kElbow].p_in_rig_m - arm.joints[kShoulder].p_in_rig_m)), 1e-5);
      EXPECT_LT(norm(to_hand - avatar(arm.joints[kHand].p_in_rig_m - arm.joints[kElbow].p_in_rig_m)), 1e-5);
      EXPECT_NEAR(lower[0], rest.x * kUpper_m, 1e-6);
      EXPECT_NEAR(hand[0], rest.x * kLower_m, 1e-6);
    }
  }
}

/// By hand: a right arm stretched out sideways with the forearm to the front is a T-pose but for the elbow's quarter turn.
TEST(Vmc, ElbowBendsAroundItsHinge) {
  Receiver receiver;
  auto sink = make_vmc(receiver.target());
  ASSERT_TRUE(sink);
  Instant instant;
  // The person looks at the camera: the right arm goes to the picture's left, the front is where z is less.
  instant.people = {arm_of({0, 0, 2}, {-0.3, 0, 2}, {-0.3, 0, 1.75})};
  ASSERT_TRUE((*sink)->write(instant.tracked(0)));
  auto got = receiver.next();
  ASSERT_EQ(got.size(), 6u);
  const auto expect = [](const Message& m, std::array<double, 4> q) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(m.numbers[3 + i], q[i], 1e-6) << m.words[0] << i;
  };
  const double h = std::sqrt(0.5);
  expect(got[3], {0, 0, 0, 1});
  expect(got[4], {0, -h, 0, h});
  // Straight from there: the upper arm keeps its twist.
  instant.people = {arm_of({0, 0, 2}, {-0.3, 0, 2}, {-0.55, 0, 2})};
  ASSERT_TRUE((*sink)->write(instant.tracked(1)));
  got = receiver.next();
  ASSERT_EQ(got.size(), 6u);
  expect(got[3], {0, 0, 0, 1});
  expect(got[4], {0, 0, 0, 1});
  // A lost joint: the avatar keeps its pose, and is told.
  instant.people[0].joints[kHand].state = JointState::kLost;
  ASSERT_TRUE((*sink)->write(instant.tracked(2)));
  got = receiver.next();
  ASSERT_EQ(got.size(), 3u);
  EXPECT_EQ(got[0].numbers[0], 0);
}

/// A tracked arm is a little longer or shorter in each frame: the avatar's stays as it was first.
TEST(Vmc, BonesKeepTheirLengths) {
  Receiver receiver;
  auto sink = make_vmc(receiver.target());
  ASSERT_TRUE(sink);
  Instant instant;
  for (const double longer : {1.0, 1.2, 0.9}) {
    instant.people = {arm_of({0, 0, 2}, {-0.3 * longer, 0, 2}, {-0.55 * longer, 0.02, 2})};
    ASSERT_TRUE((*sink)->write(instant.tracked(0)));
    const auto got = receiver.next();
    ASSERT_EQ(got.size(), 6u);
    EXPECT_NEAR(std::abs(got[4].numbers[0]), 0.3, 1e-6);
    EXPECT_NEAR(std::abs(got[5].numbers[0]), std::hypot(0.25, 0.02), 1e-6);
  }
}

TEST(Vmc, RotationsAlone) {
  Receiver receiver, other;
  auto whole = make_vmc(receiver.target()), rotations = make_vmc(other.target(), VmcBones::kRotations);
  ASSERT_TRUE(whole && rotations);
  Instant instant;
  instant.people = {arm_of({0, 0, 2}, {-0.3, 0, 2}, {-0.3, 0, 1.75})};
  ASSERT_TRUE((*whole)->write(instant.tracked(0)) && (*rotations)->write(instant.tracked(0)));
  const auto a = receiver.next(), b = other.next();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 3; i < a.size(); ++i) {
    EXPECT_EQ(a[i].words, b[i].words);
    for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(b[i].numbers[n], 0);
    for (std::size_t n = 3; n < 7; ++n) EXPECT_EQ(a[i].numbers[n], b[i].numbers[n]);
  }
}

/// By hand: of a body with fingers in its T-pose nothing turns, and all of Unity's bones are sent but jaw and eyes, upper chest
/// and shoulders.
TEST(Vmc, FingersAreBones) {
  Receiver receiver;
  auto sink = make_vmc(receiver.target());
  ASSERT_TRUE(sink);
  Person body = person_with(kBodyHands);
  for (std::size_t j = 0; j < kJointIds; ++j) {
    const int parent = kBodyHands.joints[j].parent;
    const Vec3 from = parent < 0 ? Vec3{0, 0, 2} : body.joints[static_cast<std::size_t>(parent)].p_in_rig_m;
    body.joints[j] = joint(parent < 0 ? from : from - 0.1 * rest_direction(kBodyHands.joints[j].id, BodyAxes::kLeftHanded));
  }
  Instant instant;
  instant.people = {body};
  ASSERT_TRUE((*sink)->write(instant.tracked(0)));
  const auto got = receiver.next();
  std::map<std::string, std::vector<double>> bones;
  for (std::size_t i = 3; i < got.size(); ++i) bones[got[i].words[0]] = got[i].numbers;
  EXPECT_EQ(bones.size(), 19u + 30);
  for (const auto& [name, n] : bones) EXPECT_NEAR(n[6], 1, 1e-6) << name;
  EXPECT_NEAR(bones["LeftIndexIntermediate"][0], -0.1, 1e-6);
  EXPECT_NEAR(bones["RightLittleDistal"][0], 0.1, 1e-6);
  EXPECT_NEAR(bones["RightThumbDistal"][2], 0.1 * std::sqrt(0.5), 1e-6);
}

/// By hand: a body in its T-pose has no turns; its hands' centres are no bones, and of two bodies the first is sent.
TEST(Vmc, ABodyByWalkingItsTable) {
  Receiver receiver;
  auto sink = make_vmc(receiver.target());
  ASSERT_TRUE(sink);
  Person body = person_with(kBody);
  for (std::size_t j = 0; j < kBody.joints.size(); ++j) {
    const int parent = kBody.joints[j].parent;
    const Vec3 from = parent < 0 ? Vec3{0, 0, 2} : body.joints[static_cast<std::size_t>(parent)].p_in_rig_m;
    const Vec3 rest = parent < 0 ? Vec3{} : rest_direction(kBody.joints[j].id, BodyAxes::kLeftHanded);
    body.joints[j] = joint(from - 0.2 * rest);
  }
  Instant instant;
  instant.people = {body, body};
  instant.people[1].id = 2;
  ASSERT_TRUE((*sink)->write(instant.tracked(0)));
  const auto got = receiver.next();
  ASSERT_EQ(got.size(), 3u + kBody.joints.size() - 2);
  std::map<std::string, std::vector<double>> bones;
  for (std::size_t i = 3; i < got.size(); ++i) bones[got[i].words[0]] = got[i].numbers;
  EXPECT_EQ(bones.size(), kBody.joints.size() - 2);
  for (const auto& [name, n] : bones) EXPECT_NEAR(n[6], 1, 1e-6) << name;
  EXPECT_NEAR(bones["LeftLowerLeg"][1], -0.2, 1e-6);
  EXPECT_NEAR(bones["LeftHand"][0], -0.2, 1e-6);
  EXPECT_NEAR(bones["RightToes"][2], 0.2, 1e-6);
  EXPECT_NEAR(bones["Hips"][1], 0, 1e-6);
}

TEST(Osc, TargetsThatCannotBe) {
  for (const char* target :
       {"", "localhost", "localhost:", ":39539", "localhost:0", "localhost:65536", "localhost:39x", "::"}) {
    const auto sink = make_osc(target, Axes::kOpencv);
    ASSERT_FALSE(sink) << target;
    EXPECT_NE(sink.error().what.find("HOST:PORT"), std::string::npos) << sink.error().what;
  }
  const auto nowhere = make_vmc("no-such-host.invalid:39539");
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().what.find("no-such-host.invalid"), std::string::npos) << nowhere.error().what;
}

TEST(Osc, NobodyListeningIsNoError) {
  std::string target;
  {
    const Receiver gone;
    target = gone.target();
  }
  auto sink = make_osc(target, Axes::kOpencv);
  ASSERT_TRUE(sink);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE((*sink)->write(Instant{}.tracked(i)));
  EXPECT_TRUE((*sink)->finish());
}

// --- In the background ----------------------------------------------------------------------------------------------------

/// Holds each frame until it is let go.
class SlowSink final : public Sink {
 public:
  struct Log {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::int64_t> written;
    int allowed = 0;
    bool finished = false, fails = false;
    Rgb8 pixel;
    void allow(int more) {
      const std::lock_guard lock(mutex);
      allowed += more;
      changed.notify_all();
    }
    void wait_for(std::size_t count) {
      std::unique_lock lock(mutex);
      EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(10), [&] { return written.size() >= count; }));
    }
  };
  explicit SlowSink(Log& log) : log_(log) {}
  bool wants_pictures() const override { return true; }
  Result<void> write(const TrackedFrame& frame) override {
    std::unique_lock lock(log_.mutex);
    log_.written.push_back(frame.number);
    log_.pixel = frame.frame->color.at(1, 1);
    log_.changed.notify_all();
    EXPECT_TRUE(log_.changed.wait_for(lock, std::chrono::seconds(10), [&] { return log_.allowed > 0; }));
    --log_.allowed;
    return log_.fails ? Result<void>(Error{ErrorCode::kWriteFailed, "full"}) : Result<void>();
  }
  Result<void> finish() override { return log_.finished = true, Result<void>(); }

 private:
  Log& log_;
};

TEST(InBackground, ASlowSinkSlowsNothingAndTheOldestGo) {
  SlowSink::Log log;
  const auto sink = *in_background(std::make_unique<SlowSink>(log));
  for (std::int64_t i = 0; i < 10; ++i) {
    Instant instant;  // gone before it is written
    instant.frame.color = Image<Rgb8>({4, 4});
    instant.frame.color.at(1, 1) = {static_cast<std::uint8_t>(10 + i), 0, 0};
    ASSERT_TRUE(sink->write(instant.tracked(i)));
    if (i == 0) log.wait_for(1);
  }
  EXPECT_EQ(sink->dropped(), 5);  // 0 is being written, 6 to 9 wait
  log.allow(5);
  ASSERT_TRUE(sink->finish());
  EXPECT_EQ(log.written, (std::vector<std::int64_t>{0, 6, 7, 8, 9}));
  EXPECT_EQ(log.pixel, (Rgb8{19, 0, 0}));
  EXPECT_TRUE(log.finished);
}

TEST(InBackground, AFailureIsToldByTheNextCall) {
  SlowSink::Log log;
  log.fails = true;
  log.allow(100);
  const auto sink = *in_background(std::make_unique<SlowSink>(log));
  Instant instant;
  instant.frame.color = Image<Rgb8>({4, 4});
  ASSERT_TRUE(sink->write(instant.tracked(0)));
  const auto finished = sink->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().what, "full");
  EXPECT_FALSE(log.finished);
}

}  // namespace
}  // namespace duo
