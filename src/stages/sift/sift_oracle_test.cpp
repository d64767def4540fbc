// SIFT against OpenCV's on the synthetic room: how good, how fast.
#include <chrono>
#include <opencv2/core/utility.hpp>

#include "duoptic/synthetic.h"
#include "stages/gray/gray.h"
#include "tests/sift_views.h"

namespace duo {
namespace {

struct Room {
  SyntheticPair truth;
  Image<std::uint8_t> left, right;
};

Room render_room() {
  SyntheticSetup setup;
  setup.ideal = true;
  Room out{render_synthetic(setup, 2), Image<std::uint8_t>(setup.size), Image<std::uint8_t>(setup.size)};
  ref::gray(out.truth.pair.left.pixels, out.left);
  ref::gray(out.truth.pair.right.pixels, out.right);
  return out;
}

const Room& room() {
  static const Room rendered = render_room();
  return rendered;
}

TEST(SiftOracle, StereoPair) {
  const Room& pair = room();
  const auto truth = [&](float x, float y) -> std::optional<PredictedPlace> {
    const int px = static_cast<int>(std::lround(x)), py = static_cast<int>(std::lround(y));
    if (pair.truth.seen_by_both.at(py, px) == 0) return {};
    return PredictedPlace{x - pair.truth.disparity_px.at(py, px), y};
  };
  test::expect_as_good_as_opencv("room stereo", test::score_both(pair.left, pair.right, 1, truth));
}

TEST(SiftOracle, Views) {
  const Room& pair = room();
  for (const test::SiftView& view : test::kSiftViews)
    test::expect_as_good_as_opencv(std::string("room ") + view.name, view.score(pair.left));
}

template <class F>
double best_ms(F&& f) {
  double best = 1e9;
  for (int i = 0; i < 15; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  return best;
}

TEST(SiftOracle, Time) {
  const Room& pair = room();
  const View<const std::uint8_t> picture = pair.left.view();
  cv::setNumThreads(1);
  Pool alone(1);
  SiftScratch scratch(picture.size(), 4000);
  SiftPoints points(4000);
  const auto ours = [&](std::initializer_list<Window> windows) {
    int count = 0;
    const double ms = best_ms([&] {
      count = 0;
      for (const Window& window : windows) {
        simd::sift(alone, picture, window, {}, scratch, points);
        count += points.count;
      }
    });
    std::printf("sift simd, %zu of %dx%d: %d points, %.2f ms\n", windows.size(), windows.begin()->width,
                windows.begin()->height, count, ms);
    return ms;
  };
  const double full = ours({Window::all(picture.size())});
  ours({{220, 140, 200, 200}});
  ours({{60, 60, 128, 128}, {256, 176, 128, 128}, {440, 300, 128, 128}});
  const auto sift = cv::SIFT::create();
  std::vector<cv::KeyPoint> found;
  cv::Mat descriptors;
  const double opencv = best_ms([&] { sift->detectAndCompute(test::mat(picture), {}, found, descriptors); });
  std::printf("OpenCV, which doubles the picture: %zu points, %.2f ms\n", found.size(), opencv);
  // The same octaves as ours: what OpenCV needs for a picture of half the size.
  cv::Mat half;
  cv::resize(test::mat(picture), half, {}, 0.5, 0.5, cv::INTER_AREA);
  std::printf("OpenCV on half the picture, which is doubled to the size of ours: ");
  const double same = best_ms([&] { sift->detectAndCompute(half, {}, found, descriptors); });
  std::printf("%zu points, %.2f ms\n", found.size(), same);
  EXPECT_LT(full, opencv);
}

}  // namespace
}  // namespace duo
