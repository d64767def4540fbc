// What other programs read: axes and tables by hand, a BVH through a strict parser and forward kinematics.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "body/bone_turns.h"
#include "duoptic/sink.h"
#include "tests/arm_poses.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the poses

TEST(Axes, TheSamePointByHand) {
  const Vec3 p{1, 2, 3};  // a metre to the right, two down, three ahead
  const std::pair<std::string_view, Vec3> table[] = {
      {"opencv", {1, 2, 3}}, {"ros", {3, -1, -2}}, {"opengl", {1, -2, -3}}, {"unity", {1, -2, 3}}, {"blender", {1, 3, -2}}};
  for (const auto& [name, want] : table) {
    const auto axes = axes_of(name);
    ASSERT_TRUE(axes) << name;
    EXPECT_EQ(axes_from_rig(*axes) * p, want) << name;
    EXPECT_EQ(determinant(axes_from_rig(*axes)), name == "unity" ? -1 : 1) << name;
  }
  EXPECT_EQ(std::size(table), kAxesNames.size());
  const auto unknown = axes_of("maya");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("opencv, ros, opengl, unity, blender"), std::string::npos);
}

TEST(Csv, BytesByHand) {
  const test::TempFolder folder;
  Instant instant;
  instant.people = {arm_of({0.1, -0.25, 1.5}, {-0.00001, 0, 2}, {1, 2, 3})};
  instant.people[0].joints[kElbow].state = JointState::kInferred;
  instant.people[0].joints[kShoulder].state = JointState::kLost;
  instant.people.push_back(instant.people[0]);
  instant.people[1].id = 7;
  instant.people[1].skeleton = &kLeftArm;
  auto sink = make_csv(folder / "arm.csv", Axes::kRos);
  ASSERT_TRUE(sink) << sink.error().what;
  ASSERT_TRUE((*sink)->write(instant.tracked(57)));
  instant.people.clear();
  ASSERT_TRUE((*sink)->write(instant.tracked(58)));
  EXPECT_FALSE(std::filesystem::exists(folder / "arm.csv"));
  ASSERT_TRUE((*sink)->finish());
  const auto rows = [](const std::string& person, const std::string& side) {
    const std::string start = "57,1.900000," + person + "," + side;
    return start + "_shoulder,,,,lost,0.0125,0.900\n" + start + "_elbow,2.0000,0.0000,0.0000,inferred,0.0125,0.900\n" + start +
           "_hand,3.0000,-1.0000,-2.0000,seen,0.0125,0.900\n";
  };
  EXPECT_EQ(bytes_of(folder / "arm.csv"),
            "frame,t_s,person,joint,x_m,y_m,z_m,state,sigma_m,confidence\n" + rows("1", "right") + rows("7", "left"));
}

// --- BVH ------------------------------------------------------------------------------------------------------------------

struct BvhJoint {
  std::string name;
  int parent = -1;
  Vec3 offset;
  std::vector<std::string> channels;
};

/// Takes nothing that the format does not have, in no other order.
struct BvhFile {
  std::vector<BvhJoint> joints;
  std::vector<std::vector<double>> frames;
  double frame_s = 0;
  bool good = false;

  explicit BvhFile(const std::string& text) : in_(text) { good = parse(); }

  /// Places of all joints in one frame.
  std::vector<Vec3> places(std::size_t frame) const {
    std::vector<Vec3> out(joints.size());
    std::vector<Mat3> turned(joints.size());
    std::size_t value = 0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const bool root = joints[i].parent < 0;
      const auto parent = static_cast<std::size_t>(std::max(joints[i].parent, 0));
      Vec3 t = joints[i].offset;
      Mat3 r;
      for (const std::string& channel : joints[i].channels) {
        const double v = frames[frame][value++];
        const double a = v * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a);
        if (channel == "Xposition") t.x += v;
        if (channel == "Yposition") t.y += v;
        if (channel == "Zposition") t.z += v;
        if (channel == "Xrotation") r = r * Mat3{{1, 0, 0, 0, c, -s, 0, s, c}};
        if (channel == "Yrotation") r = r * Mat3{{c, 0, s, 0, 1, 0, -s, 0, c}};
        if (channel == "Zrotation") r = r * Mat3{{c, -s, 0, s, c, 0, 0, 0, 1}};
      }
      out[i] = root ? t : out[parent] + turned[parent] * t;
      turned[i] = root ? r : turned[parent] * r;
    }
    return out;
  }

 private:
  bool word(const std::string& want) {
    std::string got;
    return in_ >> got && got == want;
  }
  bool three(Vec3& v) { return static_cast<bool>(in_ >> v.x >> v.y >> v.z); }
  bool body(const std::string& name, int parent) {
    BvhJoint made{name, parent, {}, {}};
    int count = 0;
    if (!word("{") || !word("OFFSET") || !three(made.offset) || !word("CHANNELS") || !(in_ >> count)) return false;
    if (count != (parent < 0 ? 6 : 3)) return false;
    made.channels.resize(static_cast<std::size_t>(count));
    for (std::string& channel : made.channels) in_ >> channel;
    const int self = static_cast<int>(joints.size());
    joints.push_back(made);
    std::string next;
    in_ >> next;
    Vec3 end;
    if (next == "End")
      return word("Site") && word("{") && word("OFFSET") && three(end) && norm(end) > 0 && word("}") && word("}");
    return next == "JOINT" && in_ >> next && body(next, self) && word("}");
  }
  bool parse() {
    std::string next;
    if (!word("HIERARCHY")) return false;
    while (in_ >> next && next == "ROOT")
      if (!(in_ >> next) || !body(next, -1)) return false;
    std::size_t count = 0, values = 0;
    if (next != "MOTION" || !word("Frames:") || !(in_ >> count) || !word("Frame") || !word("Time:") || !(in_ >> frame_s))
      return false;
    for (const BvhJoint& joint : joints) values += joint.channels.size();
    std::getline(in_, next);
    for (std::string line; std::getline(in_, line);) {
      std::istringstream numbers(line);
      auto& frame = frames.emplace_back();
      for (double v = 0; numbers >> v;) frame.push_back(v);
      if (!numbers.eof() || frame.size() != values) return false;
    }
    return frames.size() == count;
  }

  std::istringstream in_;
};

Vec3 y_up(const Person& person, std::size_t j) { return axes_from_rig(Axes::kOpengl) * person.joints[j].p_in_rig_m; }

TEST(Bvh, ForwardKinematicsGivesTheJointsBack) {
  const test::TempFolder folder;
  constexpr int kFrames = 200;
  const auto right = wandering_arm(kFrames, 1), left = wandering_arm(kFrames, 2, kLeftArm, 2);
  auto sink = make_bvh(folder / "arms.bvh", {});
  ASSERT_TRUE(sink) << sink.error().what;
  Instant instant;
  for (std::size_t i = 0; i < kFrames; ++i) {
    instant.people = {right[i], left[i]};
    ASSERT_TRUE((*sink)->write(instant.tracked(static_cast<std::int64_t>(i))));
  }
  ASSERT_TRUE((*sink)->finish());
  const BvhFile bvh(bytes_of(folder / "arms.bvh"));
  ASSERT_TRUE(bvh.good);
  ASSERT_EQ(bvh.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(bvh.frame_s, 1.0 / 30, 1e-7);
  const std::vector<std::string> names = {"RightArm", "RightForeArm", "RightHand", "LeftArm", "LeftForeArm", "LeftHand"};
  ASSERT_EQ(bvh.joints.size(), names.size());
  for (std::size_t j = 0; j < names.size(); ++j) EXPECT_EQ(bvh.joints[j].name, names[j]);
  // The person looks along z, away from the camera's view: left is +x.
  EXPECT_NEAR(bvh.joints[1].offset.x, -kUpper_m, 1e-6);
  EXPECT_NEAR(bvh.joints[4].offset.x, kUpper_m, 1e-6);
  EXPECT_NEAR(bvh.joints[5].offset.x, kLower_m, 1e-6);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const std::vector<Vec3> places = bvh.places(i);
    for (std::size_t arm = 0; arm < 2; ++arm) {
      const Person& want = arm == 0 ? right[i] : left[i];
      EXPECT_LT(norm(places[3 * arm] - y_up(want, kShoulder)), 1e-3) << i;
      EXPECT_LT(norm(places[3 * arm + 1] - y_up(want, kElbow)), 1e-3) << i;
      EXPECT_LT(norm(places[3 * arm + 2] - y_up(want, kHand)), 1e-3) << i;
    }
  }
}

TEST(Bvh, LostAndLeftOutFramesHoldTheLastPose) {
  const test::TempFolder folder;
  auto poses = wandering_arm(3, 3, kLeftArm);
  auto sink = make_bvh(folder / "arm.bvh", {});
  ASSERT_TRUE(sink);
  Instant instant;
  const auto write = [&](std::int64_t number, const Person& pose) {
    instant.people = {pose};
    ASSERT_TRUE((*sink)->write(instant.tracked(number)));
  };
  Person lost = poses[2];
  lost.joints[kHand].state = JointState::kLost;
  write(10, lost);  // before anything is known
  write(11, poses[0]);
  write(14, poses[1]);  // 12 and 13 were dropped
  write(15, lost);
  ASSERT_TRUE((*sink)->finish());
  const BvhFile bvh(bytes_of(folder / "arm.bvh"));
  ASSERT_TRUE(bvh.good);
  ASSERT_EQ(bvh.frames.size(), 6u);
  for (const std::size_t i : {0, 1, 2, 3, 4, 5})
    EXPECT_LT(norm(bvh.places(i)[2] - y_up(poses[i < 4 ? 0 : 1], kHand)), 1e-3) << i;
}

TEST(Bvh, NothingKnownIsStillAFile) {
  const test::TempFolder folder;
  TrackHeader header;
  header.skeletons = {&kLeftArm};
  auto sink = make_bvh(folder / "arm.bvh", header);
  ASSERT_TRUE(sink);
  ASSERT_TRUE((*sink)->write(Instant{}.tracked(0)));
  ASSERT_TRUE((*sink)->finish());
  const BvhFile bvh(bytes_of(folder / "arm.bvh"));
  ASSERT_TRUE(bvh.good);
  EXPECT_EQ(bvh.joints.size(), 3u);
}

/// By hand: a body in its T-pose has no turns, and lies in the file as it was; two of them have names of their own.
TEST(Bvh, ABodyByWalkingItsTable) {
  const test::TempFolder folder;
  Person body = person_with(kBody);
  for (std::size_t j = 0; j < kBody.joints.size(); ++j) {
    const int parent = kBody.joints[j].parent;
    const Vec3 from = parent < 0 ? Vec3{0, 0, 2} : body.joints[static_cast<std::size_t>(parent)].p_in_rig_m;
    const Vec3 rest = parent < 0 ? Vec3{} : rest_direction(kBody.joints[j].id, BodyAxes::kRightHanded);
    body.joints[j] = joint(from + 0.2 * (axes_from_rig(Axes::kOpengl) * rest));  // its own inverse
  }
  Instant instant;
  instant.people = {body, body};
  instant.people[1].id = 2;
  auto sink = make_bvh(folder / "bodies.bvh", {});
  ASSERT_TRUE(sink);
  ASSERT_TRUE((*sink)->write(instant.tracked(0)));
  ASSERT_TRUE((*sink)->finish());
  const std::string text = bytes_of(folder / "bodies.bvh");
  EXPECT_NE(text.find("ROOT Hips\n{\n\tOFFSET 0.000000 0.000000 0.000000\n\tCHANNELS 6 Xposition"), std::string::npos) << text;
  EXPECT_NE(text.find("\tJOINT LeftUpLeg\n\t{\n\t\tOFFSET 0.200000 0.000000 0.000000\n"), std::string::npos);
  EXPECT_NE(text.find("\t\tJOINT RightLeg_2\n\t\t{\n\t\t\tOFFSET 0.000000 -0.200000 0.000000\n"), std::string::npos);
  const std::size_t motion = text.find("Frame Time:");
  std::istringstream values(text.substr(text.find('\n', motion)));
  std::vector<double> numbers;
  for (double v = 0; values >> v;) numbers.push_back(v);
  ASSERT_EQ(numbers.size(), 2 * (3 + 3 * kBody.joints.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_NEAR(numbers[i], i % (numbers.size() / 2) == 2 ? -2.0 : 0.0, 1e-6) << i;
}

// --- TRC and glTF -----------------------------------------------------------------------------------------------------------

TEST(Trc, BytesByHand) {
  const test::TempFolder folder;
  auto sink = make_trc(folder / "arm.trc", {});
  ASSERT_TRUE(sink) << sink.error().what;
  Instant instant;
  instant.people = {arm_of({0.1, -0.25, 1.5}, {-0.000001, 0, 2}, {1, 2, 3})};
  ASSERT_TRUE((*sink)->write(instant.tracked(10)));
  instant.people[0].joints[kHand].state = JointState::kLost;
  ASSERT_TRUE((*sink)->write(instant.tracked(12)));  // 11 was dropped
  EXPECT_FALSE(std::filesystem::exists(folder / "arm.trc"));
  ASSERT_TRUE((*sink)->finish());
  EXPECT_EQ(bytes_of(folder / "arm.trc"),
            "PathFileType\t4\t(X/Y/Z)\tarm.trc\n"
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
            "30.0000\t30.0000\t3\t3\tm\t30.0000\t1\t3\n"
            "Frame#\tTime\tright_shoulder\t\t\tright_elbow\t\t\tright_hand\t\t\n"
            "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\n"
            "\n"
            "1\t0.000000\t0.10000\t0.25000\t-1.50000\t0.00000\t0.00000\t-2.00000\t1.00000\t-2.00000\t-3.00000\n"
            "2\t0.033333\t\t\t\t\t\t\t\t\t\n"
            "3\t0.066667\t0.10000\t0.25000\t-1.50000\t0.00000\t0.00000\t-2.00000\t\t\t\n");
}

TEST(Trc, TwoPeopleHaveNamesOfTheirOwnAndNobodyIsATableToo) {
  const test::TempFolder folder;
  TrackHeader header;
  header.skeletons = {&kLeftArm};
  auto nobody = make_trc(folder / "nobody.trc", header);
  ASSERT_TRUE(nobody);
  ASSERT_TRUE((*nobody)->write(Instant{}.tracked(0)));
  ASSERT_TRUE((*nobody)->finish());
  EXPECT_NE(bytes_of(folder / "nobody.trc").find("\tleft_hand\t"), std::string::npos);
  auto two = make_trc(folder / "two.trc", header);
  Instant instant;
  instant.people = {arm_of({}, {}, {}), arm_of({}, {}, {}, kRightArm, 5)};
  ASSERT_TRUE((*two)->write(instant.tracked(0)));
  ASSERT_TRUE((*two)->finish());
  const std::string text = bytes_of(folder / "two.trc");
  EXPECT_NE(text.find("\tright_hand\t\t\tright_shoulder_5\t"), std::string::npos) << text;
}

/// By forward kinematics over the nodes, from the file's own numbers.
TEST(Gltf, ForwardKinematicsGivesTheJointsBack) {
  const test::TempFolder folder;
  constexpr int kFrames = 50;
  const auto right = wandering_arm(kFrames, 1), left = wandering_arm(kFrames, 2, kLeftArm, 2);
  auto sink = make_gltf(folder / "arms.glb", {});
  ASSERT_TRUE(sink) << sink.error().what;
  Instant instant;
  for (std::size_t i = 0; i < kFrames; ++i) {
    instant.people = {right[i], left[i]};
    ASSERT_TRUE((*sink)->write(instant.tracked(static_cast<std::int64_t>(i))));
  }
  ASSERT_TRUE((*sink)->finish());
  const std::string bytes = bytes_of(folder / "arms.glb");
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  const std::size_t numbers_at = 20 + word(12) + 8;
  EXPECT_EQ(word(numbers_at - 8), bytes.size() - numbers_at);
  const auto gltf = nlohmann::json::parse(bytes.substr(20, word(12)));
  const auto value = [&](int accessor, std::size_t i) {
    const auto& view = gltf["bufferViews"][gltf["accessors"][accessor]["bufferView"].get<int>()];
    float out = 0;
    std::memcpy(&out, bytes.data() + numbers_at + view["byteOffset"].get<std::size_t>() + 4 * i, 4);
    return static_cast<double>(out);
  };
  const auto& animation = gltf["animations"][0];
  std::map<std::pair<int, std::string>, int> outputs;  // accessor by node and what of it is animated
  for (const auto& channel : animation["channels"])
    outputs[{channel["target"]["node"], channel["target"]["path"]}] =
        animation["samplers"][channel["sampler"].get<int>()]["output"];
  EXPECT_NEAR(gltf["accessors"][animation["samplers"][0]["input"].get<int>()]["max"][0].get<double>(), (kFrames - 1) / 30.0,
              1e-5);
  for (std::size_t i = 0; i < kFrames; ++i)
    for (const int arm : {0, 1}) {
      const int root = 3 * arm;
      EXPECT_EQ(gltf["scenes"][0]["nodes"][static_cast<std::size_t>(arm)], root);
      const Person& want = arm == 0 ? right[i] : left[i];
      const auto turned = [&](int node, Vec3 v) {
        const int at = outputs.at({node, "rotation"});
        const Vec3 u{value(at, 4 * i), value(at, 4 * i + 1), value(at, 4 * i + 2)};
        return v + 2.0 * cross(u, cross(u, v) + value(at, 4 * i + 3) * v);
      };
      const auto offset = [&](int node) {
        const auto t = gltf["nodes"][static_cast<std::size_t>(node)]["translation"];
        return Vec3{t[0], t[1], t[2]};
      };
      EXPECT_EQ(gltf["nodes"][static_cast<std::size_t>(root)]["children"], nlohmann::json({root + 1}));
      const int at = outputs.at({root, "translation"});
      const Vec3 shoulder{value(at, 3 * i), value(at, 3 * i + 1), value(at, 3 * i + 2)};
      const Vec3 elbow = shoulder + turned(root, offset(root + 1));
      const Vec3 hand = elbow + turned(root, turned(root + 1, offset(root + 2)));
      EXPECT_LT(norm(shoulder - y_up(want, kShoulder)), 1e-3) << i;
      EXPECT_LT(norm(elbow - y_up(want, kElbow)), 1e-3) << i;
      EXPECT_LT(norm(hand - y_up(want, kHand)), 1e-3) << i;
    }
}

}  // namespace
}  // namespace duo
