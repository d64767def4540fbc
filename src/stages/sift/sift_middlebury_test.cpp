// SIFT against OpenCV's on Middlebury's stereo pairs, and on second views of some of their pictures.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "duoptic/source.h"
#include "tests/data.h"
#include "tests/sift_views.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

class SiftMiddlebury : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::data_folder() / "middlebury";
    if (!fs::exists(folder_)) GTEST_SKIP() << "skipped: no data";
  }
  cv::Mat read(const std::string& scene, const char* name) const {
    Picture picture;
    const auto file = open_source(folder_ / scene / name);
    EXPECT_TRUE(file && (*file)->next(picture)) << scene << " " << name;
    const cv::Mat rgb(picture.pixels.height(), picture.pixels.width(), CV_8UC3, picture.pixels.row(0),
                      static_cast<std::size_t>(picture.pixels.stride()) * sizeof(Rgb8));
    cv::Mat gray;
    cv::cvtColor(rgb, gray, cv::COLOR_RGB2GRAY);
    return gray;
  }
  fs::path folder_;
};

constexpr const char* kScenes[] = {"tsukuba", "venus", "teddy", "cones", "sawtooth", "bull", "poster", "barn1", "map"};

TEST_F(SiftMiddlebury, StereoPairs) {
  test::SiftScores all;
  for (const std::string scene : kScenes) {
    std::ifstream file(folder_ / scene / "meta.json");
    const double scale = nlohmann::json::parse(file)["gt_scale"];
    const cv::Mat disparity = read(scene, "disp_left.png");
    const auto truth = [&](float x, float y) -> std::optional<PredictedPlace> {
      const int value = disparity.at<std::uint8_t>(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x)));
      const float to = x - static_cast<float>(value / scale);
      if (value == 0 || to < 0) return {};
      return PredictedPlace{to, y};
    };
    const auto scores = test::score_both(test::image(read(scene, "left.png")), test::image(read(scene, "right.png")), 1, truth);
    test::expect_as_good_as_opencv(scene + " stereo", scores);
    all.add(scores);
  }
  test::expect_as_good_as_opencv_on_all("all stereo", all);
}

TEST_F(SiftMiddlebury, Views) {
  for (const test::SiftView& view : test::kSiftViews) {
    test::SiftScores all;
    for (const std::string scene : kScenes) {
      const auto scores = view.score(test::image(read(scene, "left.png")));
      test::expect_as_good_as_opencv(scene + " " + view.name, scores);
      all.add(scores);
    }
    test::expect_as_good_as_opencv_on_all(std::string("all ") + view.name, all);
  }
}

}  // namespace
}  // namespace duo
