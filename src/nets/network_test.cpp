#include "duoptic/network.h"

#include <algorithm>
#include <cmath>

#include "tests/agree.h"
#include "tests/model_files.h"

namespace duo {
namespace {

std::vector<float> answer(const std::string& model, const std::string& engine, int threads) {
  auto network = open_network(test::model_path(model), engine, threads);
  if (!network) throw std::runtime_error(network.error().what);
  for (int run = 0; run < 2; ++run)
    if (auto ran = (*network)->run(); !ran) throw std::runtime_error(ran.error().what);
  return (*network)->answer();
}

TEST(Network, ThreadsGiveTheSame) {
  const auto one = answer("hand_lite", "simd", 1);
  EXPECT_EQ(one, answer("hand_lite", "simd", 2));
  EXPECT_EQ(one, answer("hand_lite", "simd", 5));
  EXPECT_GT(*std::max_element(one.begin(), one.end()), 1);
}

// The points, up to 256 px, are what the same weights give without rounding of what lies between the layers.
TEST(Network, IsNearFloatingPoint) {
  if (!has_xnnpack()) GTEST_SKIP() << "this build has no XNNPACK";
  for (const char* model : {"person_detector", "body_lite", "body_full", "hand_lite", "hand_full"}) {
    const auto ours = answer(model, "simd", 1), floats = answer(model, "XNNPACK", 1);
    ASSERT_EQ(ours.size(), floats.size());
    for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], floats[i], 1) << model << " value " << i;
  }
}

TEST(Network, Errors) {
  const auto unknown = open_network(test::model_path("hand_lite"), "abacus", 1);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().what, "run hand_lite on \"abacus\": this build has no such engine for networks");
  EXPECT_FALSE(open_network(test::model_path("none"), "simd", 1));
}

}  // namespace
}  // namespace duo
