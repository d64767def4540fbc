// What the integers cost: the project's networks beside the published ones in floating point, on the same crops of real and
// rendered people. tools/models/reference ran the floats; with DUOPTIC_CROPS=FOLDER this test writes the crops that it needs.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "detectors/place.h"
#include "detectors/see_points.h"
#include "duoptic/skeleton.h"
#include "duoptic/source.h"
#include "duoptic/statistics.h"
#include "duoptic/synthetic.h"
#include "nets/net_run.h"
#include "stages/crop_square16/crop_square16.h"
#include "tests/agree.h"
#include "tests/data.h"
#include "tests/model_files.h"

namespace duo {
namespace {

constexpr int kEvery = 12;  // frames of a clip

using Places = std::map<std::string, std::array<double, 2>, std::less<>>;  // px, by the names of joints

struct Shown {
  std::string source;  // a clip or photograph
  int frame = 0;
  Image<Rgb8> picture;
  Places truth = {};  // what the left camera sees of it
};

void add_file(std::vector<Shown>& out, const std::string& name, const std::filesystem::path& file) {
  const auto source = open_source(file);
  ASSERT_TRUE(source) << source.error().what;
  Picture picture;
  for (int frame = 0;; ++frame) {
    const auto next = (*source)->next(picture);
    if (!next || *next != Next::kNew) return;
    if (frame % kEvery == 0) out.push_back({name, frame, std::move(picture.pixels)});
  }
}

void add_clip(std::vector<Shown>& out, const std::string& name, const std::filesystem::path& folder) {
  const std::size_t first = out.size();
  add_file(out, name, folder / "left.avi");
  const auto truth = nlohmann::json::parse(std::ifstream(folder / "truth.json"));
  for (Shown& shown : std::span(out).subspan(first))
    for (const auto& [joint, at] : truth["frames"][shown.frame]["joints"].items())
      if (!at["uv_left"].is_null()) shown.truth[joint] = at["uv_left"];
}

/// A person that pinches: the fingers, too, are known.
void add_pinch(std::vector<Shown>& out) {
  auto clip = SyntheticClip::open({.seed = 51, .script = "pinch"}, 2);
  ASSERT_TRUE(clip) << clip.error().what;
  for (int frame = 0; frame < clip->setup().frames; frame += kEvery) {
    SyntheticClipFrame made = clip->frame(frame);
    out.push_back({"pinch", frame, std::move(made.pair.left.pixels)});
    for (const SyntheticJoint& joint : made.joints)
      if (joint.visible_left)
        out.back().truth[std::string(kBodyHands.joints[*kBodyHands.index_of(joint.id)].name)] = *joint.uv_left_px;
  }
}

/// Some frames of the clips and of a synthetic person, and photographs.
const std::vector<Shown>& pictures() {
  static std::vector<Shown> all;
  if (!all.empty()) return all;
  const auto folder = test::data_folder() / "sequences";
  for (const char* clip : {"dev_easy_wave", "dev_hard_beige", "dev_full_walk", "dev_full_turn"})
    add_clip(all, clip, folder / clip);
  for (const char* photograph :
       {"dist_cm_150_350/151448", "dist_cm_204_722/152356", "dist_cm_790/153041", "group/153459", "group/153538"})
    add_file(all, photograph, folder / "persons_lab_1080p" / (std::string(photograph) + "_left.jpg"));
  add_pinch(all);
  return all;
}

/// Whether that person of a picture is one whose joints are known, or nobody's are.
bool is_person(const Shown& shown, const TurnedSquare& region) {
  const auto inside = [&](const auto& joint) {
    return std::max(std::abs(joint.second[0] - region.x_q8 / 256.0), std::abs(joint.second[1] - region.y_q8 / 256.0)) <
           half_side(region) / 256.0;
  };
  return 2 * std::ranges::count_if(shown.truth, inside) >= static_cast<std::ptrdiff_t>(shown.truth.size());
}

/// Writes each crop of people and hands as int16, and where it is from.
void write_crops(const std::filesystem::path& folder) {
  const auto detector = make_detector({.hands = true, .threads = 2});
  ASSERT_TRUE(detector) << detector.error().what;
  PeopleFinder finder(**detector, {});
  nlohmann::json bodies = nlohmann::json::array(), hands = nlohmann::json::array();
  Pool pool(1);
  const auto write = [&](nlohmann::json& list, const char* kind, int side, const Shown& shown, const TurnedSquare& region) {
    std::vector<std::int16_t> crop(static_cast<std::size_t>(side) * side * 3);
    simd::crop_square16(pool, shown.picture.view(), region, Outside::kEdge, 0, {crop.data(), {side, side}, 3});
    std::ofstream(folder / (std::string(kind) + std::to_string(list.size()) + ".raw"), std::ios::binary)
        .write(reinterpret_cast<const char*>(crop.data()), static_cast<std::streamsize>(crop.size() * 2));
    list.push_back({{"source", shown.source},
                    {"frame", shown.frame},
                    {"region", {region.x_q8, region.y_q8, region.right_x_q8, region.right_y_q8}}});
  };
  for (const Shown& shown : pictures())
    for (const SeenPerson& person : finder.look(shown.picture.view())) {
      if (!is_person(shown, person.body.next)) continue;
      write(bodies, "body", kBodySide, shown, person.body.next);
      for (const bool left : {true, false})
        if (const auto region = hand_region(person.body, left, shown.picture.size())) {
          write(hands, "hand", kHandSide, shown, *region);
          hands.back()["side"] = left ? "left" : "right";
        }
    }
  std::ofstream(folder / "crops.json") << nlohmann::json{{"body", bodies}, {"hand", hands}}.dump();
}

/// Joints of the clips' truth, as points of a body.
constexpr std::pair<const char*, BodyPoint> kTrueJoints[] = {
    {"left_shoulder", BodyPoint::kLeftShoulder}, {"right_shoulder", BodyPoint::kRightShoulder},
    {"left_elbow", BodyPoint::kLeftElbow},       {"right_elbow", BodyPoint::kRightElbow},
    {"left_wrist", BodyPoint::kLeftWrist},       {"right_wrist", BodyPoint::kRightWrist},
    {"left_hip", BodyPoint::kLeftHip},           {"right_hip", BodyPoint::kRightHip}};

class Accuracy : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(test::data_folder() / "sequences/persons_lab_1080p")) GTEST_SKIP() << "no test data";
  }
  const std::string model_ = GetParam();
  const bool body_ = model_.starts_with("body");
};

/// Where a point of the crop is in the picture, px. `u`, `v`: 0 in the crop's middle, 1 at its right and lower edge.
std::array<double, 2> in_picture(const TurnedSquare& region, double u, double v) {
  return {(region.x_q8 + u * region.right_x_q8 - v * region.right_y_q8) / 256,
          (region.y_q8 + u * region.right_y_q8 + v * region.right_x_q8) / 256};
}

double distance(const std::array<double, 2>& a, const std::array<double, 2>& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

double probability(double logit) { return 1 / (1 + std::exp(-logit)); }

TEST_P(Accuracy, LikeFloatingPoint) {
  std::ifstream file("tests/data/nets/" + model_ + ".json");
  ASSERT_TRUE(file) << "run tools/models/reference";
  const auto reference = nlohmann::json::parse(file);
  const auto net = read_net(test::model_path(model_));
  ASSERT_TRUE(net) << net.error().what;
  NetRun run(*net, NetRun::Loops::kVectors);
  Pool pool(2);
  const auto result = [&](const char* name) {
    const int tensor = net->output(name).value();
    return Result16{run.tensor(tensor), net->tensors[tensor].exponent};
  };
  const std::size_t count = body_ ? kBodyPoints : kHandPoints;
  const int values = body_ ? 5 : 3;
  std::vector<double> raw_px, shown_px, visibility, presence;
  double error_px = 0, float_error_px = 0;  // to the truth, sums
  int known = 0;
  for (const auto& sample : reference) {
    const auto shown = std::ranges::find_if(
        pictures(), [&](const Shown& s) { return sample["source"] == s.source && sample["frame"] == s.frame; });
    ASSERT_NE(shown, pictures().end()) << sample["source"];
    const auto& r = sample["region"];
    const TurnedSquare region = {r[0], r[1], r[2], r[3]};
    simd::crop_square16(pool, shown->picture.view(), region, Outside::kEdge, 0, run.input());
    ASSERT_EQ(std::to_string(test::hash_of(run.input())), sample["hash"]) << "the floats saw another crop";
    run.run(pool);
    const Result16 points = result("points");
    const double step = std::ldexp(1, -points.exponent);
    presence.push_back(std::abs(probability(std::ldexp(result("presence").values.data()[0], -result("presence").exponent)) -
                                probability(sample["presence"])));
    const auto compare = [&](std::string_view joint, const std::array<double, 2>& got, const std::array<double, 2>& floats) {
      const auto truth = shown->truth.find(joint);
      if (truth == shown->truth.end()) return;
      error_px += distance(got, truth->second);
      float_error_px += distance(floats, truth->second);
      ++known;
    };
    std::vector<std::array<double, 2>> raw(count), float_raw(count);  // in the crop, px
    for (std::size_t i = 0; i < count; ++i) {
      const std::int16_t* got = points.values.data() + values * static_cast<int>(i);
      raw[i] = {got[0] * step, got[1] * step};
      float_raw[i] = {sample["raw"][2 * i], sample["raw"][2 * i + 1]};
      raw_px.push_back(distance(raw[i], float_raw[i]));
      if (body_) visibility.push_back(std::abs(probability(got[3] * step) - sample["visible"][i].get<double>()));
    }
    if (!body_) {
      if (sample["presence"] < 0) continue;
      const Side side = sample["side"] == "left" ? Side::kLeft : Side::kRight;
      for (std::size_t i = 0; i < kFingerJoints; ++i) {
        const JointId id = finger_joint(side, {i / kJointsPerFinger, i % kJointsPerFinger});
        const auto place = [&](const std::array<double, 2>& p) { return in_picture(region, p[0] / 112 - 1, p[1] / 112 - 1); };
        compare(kBodyHands.joints[*kBodyHands.index_of(id)].name, place(raw[i + 1]), place(float_raw[i + 1]));
      }
      continue;
    }
    const SeenBody body = see_body(points, result("heat"), result("world"), result("presence"), region);
    const auto place = [&](std::size_t i) { return std::array{body.points[i].x_px(), body.points[i].y_px()}; };
    const auto float_place = [&](std::size_t i) {
      return in_picture(region, sample["shown"][2 * i].get<double>() / 128 - 1,
                        sample["shown"][2 * i + 1].get<double>() / 128 - 1);
    };
    const double crop_px = 128.0 * 256 / half_side(region);
    for (std::size_t i = 0; i < kBodyPoints; ++i)
      if (sample["visible"][i] >= 0.5) shown_px.push_back(crop_px * distance(place(i), float_place(i)));
    for (const auto& [joint, point] : kTrueJoints) {
      const auto i = static_cast<std::size_t>(point);
      compare(joint, place(i), float_place(i));
    }
  }
  std::printf("%s, %zu crops: raw %.3f px median, %.3f at 95 %%; to the truth of %d joints %.2f px, %.4f times the floats'",
              model_.c_str(), reference.size(), quantile(raw_px, 0.5), quantile(raw_px, 0.95), known, error_px / known,
              error_px / float_error_px);
  EXPECT_LE(quantile(raw_px, 0.5), 0.12);
  EXPECT_LE(quantile(raw_px, 0.95), 0.4);
  EXPECT_LE(quantile(presence, 0.95), 0.03);
  EXPECT_GE(known, 80);
  EXPECT_NEAR(error_px / float_error_px, 1, 0.01);
  if (body_) {
    std::printf("; visible refined %.3f at 99 %%; visibility %.4f at 95 %%", quantile(shown_px, 0.99),
                quantile(visibility, 0.95));
    EXPECT_LE(quantile(shown_px, 0.99), 0.5);
    EXPECT_LE(quantile(visibility, 0.95), 0.03);
  }
  std::printf("\n");
}

INSTANTIATE_TEST_SUITE_P(, Accuracy, testing::Values("body_lite", "body_full", "hand_lite", "hand_full"),
                         [](const auto& info) { return std::string(info.param); });

TEST(WriteCrops, WhereAsked) {
  const char* folder = std::getenv("DUOPTIC_CROPS");
  if (folder == nullptr) GTEST_SKIP() << "for tools/models/reference";
  write_crops(folder);
}

}  // namespace
}  // namespace duo
