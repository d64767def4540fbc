// Depth of people at distances that a laser measured. The pairs are rectified, but nothing says what their focal length times
// baseline is: for each folder it is taken from all the others, as the median of distance times disparity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/source.h"
#include "tests/data.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// A torso in all pictures of a folder, marked by hand: shares of the picture's width and height.
struct Torso {
  const char* folder;
  double distance_m, left, right, top, bottom;
};
constexpr Torso kTorsos[] = {
    {"dist_cm_160", 1.60, 0.53, 0.59, 0.25, 0.52},       {"dist_cm_240", 2.40, 0.535, 0.585, 0.30, 0.48},
    {"dist_cm_150_350", 1.50, 0.70, 0.82, 0.22, 0.52},   {"dist_cm_150_350", 3.50, 0.49, 0.55, 0.36, 0.50},
    {"dist_cm_176", 1.76, 0.52, 0.61, 0.25, 0.54},       {"dist_cm_176_504", 1.76, 0.34, 0.43, 0.25, 0.55},
    {"dist_cm_176_504", 5.04, 0.603, 0.622, 0.40, 0.49}, {"dist_cm_204_722", 2.04, 0.37, 0.48, 0.26, 0.53},
    {"dist_cm_204_722", 7.22, 0.59, 0.615, 0.425, 0.49}, {"dist_cm_250_350", 2.50, 0.66, 0.75, 0.30, 0.51},
    {"dist_cm_250_350", 3.50, 0.49, 0.545, 0.37, 0.50},  {"dist_cm_298_604", 2.98, 0.47, 0.55, 0.33, 0.49},
    {"dist_cm_298_604", 6.04, 0.585, 0.612, 0.41, 0.50}, {"dist_cm_790", 7.90, 0.515, 0.535, 0.50, 0.56}};

class LabDistances : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::data_folder() / "sequences" / "persons_lab_1080p";
    if (!fs::exists(folder_)) GTEST_SKIP() << "skipped: no data";
  }
  /// Median disparity of the torso in each pair of its folder, pixels.
  std::vector<double> disparities_px(const Torso& torso) {
    std::vector<fs::path> lefts;
    for (const auto& entry : fs::directory_iterator(folder_ / torso.folder))
      if (entry.path().filename().string().ends_with("_left.jpg")) lefts.push_back(entry.path());
    std::sort(lefts.begin(), lefts.end());
    std::vector<double> out;
    for (const fs::path& left : lefts) out.push_back(disparity_px(left, torso));
    return out;
  }

 private:
  double disparity_px(const fs::path& left, const Torso& torso) {
    std::string right = left.string();
    right.replace(right.rfind("_left"), 5, "_right");
    auto pairs = open_pairs(left, right);
    EXPECT_TRUE(pairs) << pairs.error().what;
    Pair pair;
    const auto next = (*pairs)->next(pair);
    EXPECT_TRUE(next && *next == Next::kPicture);
    if (!engine_) {
      engine_ = std::move(*make_engine("simd", 2));
      duo::Setup setup;
      setup.size = (*pairs)->size();
      // The matcher the figures were taken with. sgm meets one torso more (25 of 29) but misses another by more than the slack:
      // see docs/measurements.md.
      setup.matcher = "pyramid";
      setup.max_disparity = 128;
      EXPECT_TRUE(engine_->prepare(setup));
    }
    engine_->submit(pair);
    const Image<std::uint16_t>& d_q4 = engine_->collect().disparity.d_q4;
    const auto at = [](double share, int length) { return static_cast<int>(share * length); };
    std::vector<int> known;
    for (int y = at(torso.top, d_q4.height()); y < at(torso.bottom, d_q4.height()); ++y)
      for (int x = at(torso.left, d_q4.width()); x < at(torso.right, d_q4.width()); ++x)
        if (d_q4.at(y, x) != Disparity::kNone) known.push_back(d_q4.at(y, x));
    EXPECT_GT(known.size(), 100U) << left;
    if (known.empty()) return 0;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    return *middle / 16.0;
  }

  fs::path folder_;
  std::unique_ptr<Engine> engine_;
};

// The named distances contradict each other by some centimetres: two persons at "1.76 m" have disparities 3 % apart, and one at
// "1.60 m", in the same place of the picture, is only 5 % nearer than the first of them. So most pairs must hold the limit, and
// each with kNamedM more.
TEST_F(LabDistances, WithinThreePercentAndOneStep) {
  constexpr double kShare = 0.03, kNamedM = 0.06;
  struct Sample {
    const Torso* torso;
    double d_px;
  };
  std::vector<Sample> samples;
  for (const Torso& torso : kTorsos)
    for (const double d_px : disparities_px(torso)) samples.push_back({&torso, d_px});
  std::size_t met = 0;
  for (const Sample& sample : samples) {
    std::vector<double> products;
    for (const Sample& other : samples)
      if (std::strcmp(other.torso->folder, sample.torso->folder) != 0) products.push_back(other.torso->distance_m * other.d_px);
    std::nth_element(products.begin(), products.begin() + static_cast<std::ptrdiff_t>(products.size() / 2), products.end());
    const double scale = products[products.size() / 2], named_m = sample.torso->distance_m, found_m = scale / sample.d_px;
    const double allowed_m = kShare * named_m + found_m / sample.d_px;  // a step of one pixel
    std::printf("%.2f m: %.2f m (%.1f px, %+.1f %%)\n", named_m, found_m, sample.d_px, 100 * (found_m / named_m - 1));
    met += std::abs(found_m - named_m) <= allowed_m;
    EXPECT_NEAR(found_m, named_m, allowed_m + kNamedM) << sample.torso->folder;
  }
  std::printf("%zu of %zu within 3 %% and one step\n", met, samples.size());
  EXPECT_GE(met, 8 * samples.size() / 10);
}

}  // namespace
}  // namespace duo
