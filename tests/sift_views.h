// Second views of a picture whose every pixel's place is known.
#pragma once

#include <opencv2/imgproc.hpp>

#include "tests/sift_score.h"

namespace duo::test {

inline cv::Mat mat(View<const std::uint8_t> v) {
  return {v.height(), v.width(), CV_8U, const_cast<std::uint8_t*>(v.data()), static_cast<std::size_t>(v.stride())};
}
inline Image<std::uint8_t> image(const cv::Mat& gray) {
  Image<std::uint8_t> out({gray.cols, gray.rows});
  for (int y = 0; y < gray.rows; ++y) std::copy_n(gray.ptr(y), gray.cols, out.row(y));
  return out;
}

inline SiftScores score_turned(View<const std::uint8_t> picture, double degrees, double grown) {
  const cv::Mat to = cv::getRotationMatrix2D({picture.width() / 2.0f, picture.height() / 2.0f}, degrees, grown);
  cv::Mat turned;
  cv::warpAffine(mat(picture), turned, to, {}, cv::INTER_LINEAR);
  const auto m = [&](int row, int column) { return to.at<double>(row, column); };
  const auto truth = [&](float x, float y) -> std::optional<PredictedPlace> {
    const double px = m(0, 0) * x + m(0, 1) * y + m(0, 2), py = m(1, 0) * x + m(1, 1) * y + m(1, 2);
    if (px < 0 || py < 0 || px > picture.width() - 1 || py > picture.height() - 1) return {};
    return PredictedPlace{static_cast<float>(px), static_cast<float>(py)};
  };
  return score_both(picture, image(turned), grown, truth);
}

inline SiftScores score_noisy(View<const std::uint8_t> picture, double sigma) {
  cv::Mat noise(picture.height(), picture.width(), CV_16S), noisy;
  cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(mat(picture), noise, noisy, {}, CV_8U);
  return score_both(picture, image(noisy), 1, [](float x, float y) { return std::optional(PredictedPlace{x, y}); });
}

inline SiftScores score_darker(View<const std::uint8_t> picture, double light) {
  cv::Mat darker;
  mat(picture).convertTo(darker, CV_8U, light);
  return score_both(picture, image(darker), 1, [](float x, float y) { return std::optional(PredictedPlace{x, y}); });
}

struct SiftView {
  const char* name;
  SiftScores (*score)(View<const std::uint8_t> picture);
};
inline constexpr SiftView kSiftViews[] = {
    {"turned 15", [](View<const std::uint8_t> picture) { return score_turned(picture, 15, 1); }},
    {"x0.7", [](View<const std::uint8_t> picture) { return score_turned(picture, 0, 0.7); }},
    {"turned 30 x0.8", [](View<const std::uint8_t> picture) { return score_turned(picture, 30, 0.8); }},
    {"noise 8", [](View<const std::uint8_t> picture) { return score_noisy(picture, 8); }},
    {"light 0.6", [](View<const std::uint8_t> picture) { return score_darker(picture, 0.6); }},
};

}  // namespace duo::test
