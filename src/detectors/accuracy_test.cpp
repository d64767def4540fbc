// What the integers cost: the project's networks beside the published ones in floating point, on the same crops of real and
// rendered people. tools/models/reference ran the floats; with DUOPTIC_CROPS=FOLDER this test writes the crops that it needs.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "detectors/place.h"
#include "detectors/see_points.h"
#include "duoptic/source.h"
#include "duoptic/statistics.h"
#include "nets/net_run.h"
#include "stages/crop_square16/crop_square16.h"
#include "tests/agree.h"
#include "tests/data.h"
#include "tests/model_files.h"

namespace duo {
namespace {

constexpr const char* kClips[] = {"dev_easy_wave", "dev_hard_beige", "dev_full_walk", "dev_full_turn"};
constexpr int kEvery = 12;  // frames of a clip

/// Calls f(name, frame, picture) for some frames of the clips and for photographs.
template <class F>
void each_picture(F&& f) {
  const auto folder = test::data_folder() / "sequences";
  for (const char* clip : kClips) {
    const auto source = open_source(folder / clip / "left.avi");
    ASSERT_TRUE(source) << source.error().what;
    Picture picture;
    for (int frame = 0;; ++frame) {
      const auto next = (*source)->next(picture);
      if (!next || *next != Next::kNew) break;
      if (frame % kEvery == 0) f(std::string(clip), frame, picture.pixels.view());
    }
  }
  for (const char* photograph :
       {"dist_cm_150_350/151448", "dist_cm_204_722/152356", "dist_cm_790/153041", "group/153459", "group/153538"}) {
    const auto source = open_source(folder / "persons_lab_1080p" / (std::string(photograph) + "_left.jpg"));
    ASSERT_TRUE(source) << source.error().what;
    Picture picture;
    ASSERT_TRUE((*source)->next(picture));
    f(std::string(photograph), 0, picture.pixels.view());
  }
}

/// Writes each crop of people and hands as int16, and where it is from.
void write_crops(const std::filesystem::path& folder) {
  const auto detector = make_detector({.hands = true, .threads = 2});
  ASSERT_TRUE(detector) << detector.error().what;
  PeopleFinder finder(**detector, {});
  nlohmann::json bodies = nlohmann::json::array(), hands = nlohmann::json::array();
  Pool pool(1);
  const auto write = [&](nlohmann::json& list, const char* kind, int side, const std::string& name, int frame,
                         View<const Rgb8> picture, const TurnedSquare& region) {
    std::vector<std::int16_t> crop(static_cast<std::size_t>(side) * side * 3);
    simd::crop_square16(pool, picture, region, Outside::kEdge, 0, {crop.data(), {side, side}, 3});
    std::ofstream(folder / (std::string(kind) + std::to_string(list.size()) + ".raw"), std::ios::binary)
        .write(reinterpret_cast<const char*>(crop.data()), static_cast<std::streamsize>(crop.size() * 2));
    list.push_back(
        {{"source", name}, {"frame", frame}, {"region", {region.x_q8, region.y_q8, region.right_x_q8, region.right_y_q8}}});
  };
  each_picture([&](const std::string& name, int frame, View<const Rgb8> picture) {
    for (const SeenPerson& person : finder.look(picture)) {
      write(bodies, "body", kBodySide, name, frame, picture, person.body.next);
      for (const bool left : {true, false})
        if (const auto region = hand_region(person.body, left, picture.size()))
          write(hands, "hand", kHandSide, name, frame, picture, *region);
    }
  });
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
  std::vector<double> raw_px, shown_px, visibility, presence;
  double error_px = 0, float_error_px = 0;
  std::map<std::string, nlohmann::json> truths;
  std::size_t used = 0;
  each_picture([&](const std::string& name, int frame, View<const Rgb8> picture) {
    for (const auto& sample : reference) {
      if (sample["source"] != name || sample["frame"] != frame) continue;
      const auto& r = sample["region"];
      const TurnedSquare region = {r[0], r[1], r[2], r[3]};
      simd::crop_square16(pool, picture, region, Outside::kEdge, 0, run.input());
      ASSERT_EQ(std::to_string(test::hash_of(run.input())), sample["hash"]) << "the floats saw another crop";
      run.run(pool);
      ++used;
      const Result16 points = result("points");
      const int values = body_ ? 5 : 3;
      const double step = std::ldexp(1, -points.exponent);
      const auto probability = [](double logit) { return 1 / (1 + std::exp(-logit)); };
      presence.push_back(std::abs(probability(std::ldexp(result("presence").values.data()[0], -result("presence").exponent)) -
                                  probability(sample["presence"])));
      const std::size_t count = body_ ? kBodyPoints : kHandPoints;
      for (std::size_t i = 0; i < count; ++i) {
        const std::int16_t* got = points.values.data() + values * static_cast<int>(i);
        raw_px.push_back(std::hypot(got[0] * step - sample["raw"][2 * i].get<double>(),
                                    got[1] * step - sample["raw"][2 * i + 1].get<double>()));
        if (!body_) continue;
        visibility.push_back(std::abs(probability(got[3] * step) - sample["visible"][i].get<double>()));
      }
      if (!body_) continue;
      const SeenBody body = see_body(points, result("heat"), result("world"), result("presence"), region);
      const auto float_place = [&](std::size_t i) {
        const double u = sample["shown"][2 * i].get<double>() / 128 - 1, v = sample["shown"][2 * i + 1].get<double>() / 128 - 1;
        return std::pair{(region.x_q8 + u * region.right_x_q8 - v * region.right_y_q8) / 256,
                         (region.y_q8 + u * region.right_y_q8 + v * region.right_x_q8) / 256};
      };
      const double crop_px = 128.0 * 256 / half_side(region);
      for (std::size_t i = 0; i < kBodyPoints; ++i) {
        const auto [x, y] = float_place(i);
        if (sample["visible"][i] >= 0.5)
          shown_px.push_back(crop_px * std::hypot(body.points[i].x_px() - x, body.points[i].y_px() - y));
      }
      if (!name.starts_with("dev_")) continue;
      if (!truths.contains(name))
        truths[name] = nlohmann::json::parse(std::ifstream(test::data_folder() / "sequences" / name / "truth.json"));
      const auto& joints = truths[name]["frames"][frame]["joints"];
      for (const auto& [joint, point] : kTrueJoints) {
        if (joints[joint]["uv_left"].is_null()) continue;
        const double x = joints[joint]["uv_left"][0], y = joints[joint]["uv_left"][1];
        const auto [float_x, float_y] = float_place(static_cast<std::size_t>(point));
        error_px += std::hypot(body.at(point).x_px() - x, body.at(point).y_px() - y);
        float_error_px += std::hypot(float_x - x, float_y - y);
      }
    }
  });
  ASSERT_EQ(used, reference.size());
  std::printf("%s, %zu crops: raw %.3f px median, %.3f at 95 %%", model_.c_str(), used, quantile(raw_px, 0.5),
              quantile(raw_px, 0.95));
  EXPECT_LE(quantile(raw_px, 0.5), 0.12);
  EXPECT_LE(quantile(raw_px, 0.95), 0.4);
  EXPECT_LE(quantile(presence, 0.95), 0.03);
  if (body_) {
    std::printf("; visible refined %.3f at 99 %%; visibility %.4f at 95 %%; to the truth %.4f times the floats'",
                quantile(shown_px, 0.99), quantile(visibility, 0.95), error_px / float_error_px);
    EXPECT_LE(quantile(shown_px, 0.99), 0.5);
    EXPECT_LE(quantile(visibility, 0.95), 0.03);
    EXPECT_NEAR(error_px / float_error_px, 1, 0.01);
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
