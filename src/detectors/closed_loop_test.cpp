// A body followed through whole clips, each region from the last result: one hash on every engine, and as near to the truth as
// a loop in floating point.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "detectors/place.h"
#include "detectors/see_points.h"
#include "nets/net_run.h"
#include "stages/crop_square16/crop_square16.h"
#include "tests/agree.h"
#include "tests/closed_loop.h"
#include "tests/model_files.h"
#ifdef DUO_XNNPACK
#include "nets/float_peer.h"
#endif

namespace duo {
namespace {

/// So many pictures of a clip, all in a long run.
std::size_t looked_at(const std::vector<Picture>& pictures) {
  return test::long_run() ? pictures.size() : std::min<std::size_t>(pictures.size(), 45);
}

TEST(ClosedLoop, OneHashOnEveryEngine) {
  const auto pictures = test::pictures_of("dev_easy_wave");
  if (pictures.empty()) GTEST_SKIP() << "no test data";
  for (const BodyModel body : {BodyModel::kLite, BodyModel::kFull}) {
    const std::uint64_t whole = test::hash_of_loop(pictures, looked_at(pictures), {.body = body});
    EXPECT_EQ(test::hash_of_loop(pictures, looked_at(pictures), {.body = body, .threads = 2}), whole);
    const std::size_t few_pictures =
        test::long_run() ? pictures.size() : 8;  // plain loops take a third of a second per picture
    const std::uint64_t few = test::hash_of_loop(pictures, few_pictures, {.body = body, .plain = true});
    test::each_target([&](const std::string& target) {
      EXPECT_EQ(test::hash_of_loop(pictures, few_pictures, {.body = body}), few) << target;
    });
    EXPECT_EQ(test::hash_of_loop(pictures, few_pictures, {.body = body, .threads = 5}), few);
  }
}

#ifdef DUO_XNNPACK
constexpr std::pair<const char*, BodyPoint> kLoopJoints[] = {
    {"left_shoulder", BodyPoint::kLeftShoulder}, {"right_shoulder", BodyPoint::kRightShoulder},
    {"left_elbow", BodyPoint::kLeftElbow},       {"right_elbow", BodyPoint::kRightElbow},
    {"left_wrist", BodyPoint::kLeftWrist},       {"right_wrist", BodyPoint::kRightWrist},
    {"left_hip", BodyPoint::kLeftHip},           {"right_hip", BodyPoint::kRightHip}};

struct PlacePx {
  double x = 0, y = 0;
};

/// The loop in floating point: the same steps with XNNPACK and doubles.
class FloatLoop {
 public:
  FloatLoop(const Net& net, const TurnedSquare& start)
      : net_(net), floats_(std::move(*FloatPeer::make(net, 1))), region_(start), crop_(kBodySide * kBodySide * 3) {}

  std::array<PlacePx, kBodyPoints> look(View<const Rgb8> picture) {
    ref::crop_square16(picture, region_, Outside::kEdge, 0, {crop_.data(), {kBodySide, kBodySide}, 3});
    for (std::size_t i = 0; i < crop_.size(); ++i)
      floats_->tensor(0)[i] = std::ldexp(static_cast<float>(crop_[i]), -net_.tensors[0].exponent);
    floats_->run();
    std::array<PlacePx, kBodyPoints> out;
    for (std::size_t i = 0; i < kBodyPoints; ++i) out[i] = place(i);
    const PlacePx hips = place(kBodyPoints), top = place(kBodyPoints + 1);
    const auto q8 = [](double px) { return static_cast<std::int32_t>(std::lround(256 * px)); };
    region_ = {q8(hips.x), q8(hips.y), q8(-1.25 * (top.y - hips.y)), q8(1.25 * (top.x - hips.x))};
    return out;
  }

 private:
  PlacePx place(std::size_t i) {
    const float* points = floats_->tensor(net_.output("points").value());
    const float* heat = floats_->tensor(net_.output("heat").value());
    double u = points[5 * i], v = points[5 * i + 1];
    const int column = static_cast<int>(u / 4), row = static_cast<int>(v / 4);
    double sum = 0, sum_x = 0, sum_y = 0, most = 0;
    if (column >= 0 && column < 64 && row >= 0 && row < 64)
      for (int y = std::max(row - 3, 0); y <= std::min(row + 3, 63); ++y)
        for (int x = std::max(column - 3, 0); x <= std::min(column + 3, 63); ++x) {
          const double warm = 1 / (1 + std::exp(-heat[static_cast<std::size_t>(y * 64 + x) * 39 + i]));
          most = std::max(most, warm);
          sum += warm;
          sum_x += warm * x;
          sum_y += warm * y;
        }
    if (most >= 0.5) {
      u = 4 * sum_x / sum;
      v = 4 * sum_y / sum;
    }
    u = u / 128 - 1;
    v = v / 128 - 1;
    return {(region_.x_q8 + u * region_.right_x_q8 - v * region_.right_y_q8) / 256,
            (region_.y_q8 + u * region_.right_y_q8 + v * region_.right_x_q8) / 256};
  }

  const Net& net_;
  std::unique_ptr<FloatPeer> floats_;
  TurnedSquare region_;
  std::vector<std::int16_t> crop_;
};

TEST(ClosedLoop, AsNearToTheTruthAsFloatingPoint) {
  if (!std::filesystem::exists(test::data_folder() / "sequences/dev_easy_wave")) GTEST_SKIP() << "no test data";
  for (const BodyModel model : {BodyModel::kLite, BodyModel::kFull}) {
    const char* name = model == BodyModel::kLite ? "body_lite" : "body_full";
    const auto net = read_net(test::model_path(name));
    ASSERT_TRUE(net);
    const auto detector = make_detector({.body = model});
    ASSERT_TRUE(detector);
    double error_px = 0, float_error_px = 0;
    int joints_seen = 0;
    for (const char* clip : {"dev_easy_wave", "dev_hard_beige", "dev_full_walk", "dev_full_turn"}) {
      const auto pictures = test::pictures_of(clip);
      const auto truth = nlohmann::json::parse(std::ifstream(test::data_folder() / "sequences" / clip / "truth.json"));
      TurnedSquare region = test::start_in(pictures[0]);
      FloatLoop floats(*net, region);
      for (std::size_t i = 0; i < looked_at(pictures); ++i) {
        const Look look{pictures[i].pixels, region};
        SeenBody body;
        (*detector)->bodies({&look, 1}, {&body, 1});
        ASSERT_GE(body.score_q15, 16384) << clip << " " << i;
        region = body.next;
        const auto places = floats.look(pictures[i].pixels);
        for (const auto& [joint, point] : kLoopJoints) {
          const auto& uv = truth["frames"][i]["joints"][joint]["uv_left"];
          if (uv.is_null()) continue;
          const double x = uv[0], y = uv[1];
          const PlacePx place = places[static_cast<std::size_t>(point)];
          error_px += std::hypot(body.at(point).x_px() - x, body.at(point).y_px() - y);
          float_error_px += std::hypot(place.x - x, place.y - y);
          ++joints_seen;
        }
      }
    }
    std::printf("%s: %.2f px from the truth over %d joints, in floating point %.2f: %.4f times\n", name, error_px / joints_seen,
                joints_seen, float_error_px / joints_seen, error_px / float_error_px);
    EXPECT_NEAR(error_px / float_error_px, 1, 0.03);
  }
}
#endif

}  // namespace
}  // namespace duo
