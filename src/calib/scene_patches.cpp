#include "calib/scene_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calib/align_match.h"
#include "core/pool.h"
#include "stages/gray/gray.h"

namespace duo {
namespace {

constexpr int kSumColumns = 480;
constexpr int kPatchRadius_px = 10;  // of a patch
constexpr int kPatchStep_px = 12;    // from one to the next
constexpr int kPatchesAsOne = 3;     // that share each of their pixels
constexpr int kPatchRows_px = 3;     // above and below the row that the rig says
constexpr double kFineTexture_px = 1,
                 kCoarseTexture_px = 6;  // what is smaller is noise, what is larger is light: neither is looked at

cv::Mat mat_of(Image<float>& image) {
  return {image.height(), image.width(), CV_32F, image.row(0), sizeof(float) * static_cast<std::size_t>(image.stride())};
}

/// The texture of a mean picture.
Image<float> texture_of(const Image<std::uint32_t>& sum, double parts) {
  Image<float> out(sum.size());
  for (int y = 0; y < sum.height(); ++y)
    for (int x = 0; x < sum.width(); ++x) out.at(y, x) = static_cast<float>(sum.at(y, x) / parts);
  cv::Mat fine = mat_of(out), coarse;
  cv::GaussianBlur(fine, coarse, {}, kCoarseTexture_px);
  cv::GaussianBlur(fine, fine, {}, kFineTexture_px);
  fine -= coarse;
  return out;
}

/// Sums of squares of what patch_product() takes, around each pixel that has it all around it.
Image<float> energy_of(Image<float>& values) {
  constexpr int kColumns = 2 * kPatchRadius_px;
  Image<float> out(values.size());
  cv::Mat squares, sums = mat_of(out);
  cv::multiply(mat_of(values), mat_of(values), squares);
  cv::boxFilter(squares, sums, CV_32F, {kColumns, kColumns + 1}, {kPatchRadius_px, kPatchRadius_px}, false,
                cv::BORDER_CONSTANT);
  return out;
}

bool holds_patch(Size size, int x, int y) {
  return x >= kPatchRadius_px && y >= kPatchRadius_px && x < size.width - kPatchRadius_px && y < size.height - kPatchRadius_px;
}

/// Of all columns but the last, whose number suits no vector.
float patch_product(const Image<float>& left, int lx, int ly, const Image<float>& right, int rx, int ry) {
  constexpr std::size_t kColumns = 2 * kPatchRadius_px;
  std::array<float, kColumns> sums{};
  for (int dy = -kPatchRadius_px; dy <= kPatchRadius_px; ++dy) {
    const float *a = left.row(ly + dy) + lx - kPatchRadius_px, *b = right.row(ry + dy) + rx - kPatchRadius_px;
    for (std::size_t i = 0; i < kColumns; ++i) sums[i] += a[i] * b[i];
  }
  float sum = 0;
  for (const float part : sums) sum += part;
  return sum;
}

/// How alike a patch is in one place.
struct Alike {
  int x = 0, y = 0;
  double correlation = 0;
};

}  // namespace

PairSum::PairSum(Size size) : size_(size), gray_(size) {
  while (size.width / square_px_ > kSumColumns) square_px_ *= 2;
  const Size small = {size.width / square_px_, size.height / square_px_};
  left_ = Image<std::uint32_t>(small), right_ = Image<std::uint32_t>(small);
  for (Image<std::uint32_t>* sum : {&left_, &right_})
    for (int y = 0; y < small.height; ++y) std::fill_n(sum->row(y), small.width, 0u);
}

void PairSum::add(const Pair& pair) {
  Pool pool(1);
  const auto add = [&](const Picture& picture, Image<std::uint32_t>& to) {
    simd::gray(pool, picture.pixels, gray_);
    for (int y = 0; y < to.height(); ++y)
      for (int row = y * square_px_; row < (y + 1) * square_px_; ++row) {
        const std::uint8_t* from = gray_.row(row);
        for (int x = 0; x < to.width(); ++x)
          for (int i = 0; i < square_px_; ++i) to.at(y, x) += *from++;
      }
  };
  add(pair.left, left_);
  add(pair.right, right_);
  ++pairs_;
}

SceneMatches match_patches(const Rig& rig, const PairSum& sum) {
  constexpr double kPointSigma_px = 0.1;
  constexpr double kLeastCorrelation = 0.5, kMostElsewhere = 0.8, kMostSigma_px = 0.4;
  constexpr double kNearestOfWidth = 0.2, kBeyondOfWidth = 0.02;  // disparities that are looked at
  constexpr int kElsewhere_px = 3;
  const double square = sum.square_px_, parts = square * square * std::max(1, sum.pairs_);
  Image<float> left = texture_of(sum.left_, parts), right = texture_of(sum.right_, parts);
  const Image<float> left_energy = energy_of(left), right_energy = energy_of(right);
  Image<SlopedPixel> sloped;
  put_slopes(right, sloped);
  Image<float> slopes_down(left.size());
  for (int y = 0; y < left.height(); ++y)
    for (int x = 0; x < left.width(); ++x) slopes_down.at(y, x) = sloped.at(y, x).slope_y;
  const Image<float> steep = energy_of(slopes_down);
  const Lens left_lens(rig.left), right_lens(rig.right);
  const auto given = [&](double px) { return square * px + (square - 1) / 2; };
  const auto of_sum = [&](double px) { return (px - (square - 1) / 2) / square; };
  const double per_px = square / (rig.left.fx_px * rig.baseline_m());  // 1 / z, per pixel of disparity
  const int first = -static_cast<int>(kBeyondOfWidth * left.width()), last = static_cast<int>(kNearestOfWidth * left.width());
  SceneMatches scene;
  scene.size = sum.size_;
  scene.pairs = sum.pairs_;
  scene.share_pixels = kPatchesAsOne;
  std::vector<Alike> found;
  for (int y = kPatchRadius_px; holds_patch(left.size(), kPatchRadius_px, y); y += kPatchStep_px)
    for (int x = kPatchRadius_px; holds_patch(left.size(), x, y); x += kPatchStep_px) {
      const auto ray = left_lens.ray_of({given(x), given(y)});
      if (!ray) continue;
      found.clear();
      for (int d = first; d <= last; ++d) {
        const auto there = right_lens.pixel_of(rig.right_from_left.rotation * *ray + d * per_px * rig.right_from_left.t_m);
        if (!there) continue;
        const int rx = static_cast<int>(std::lround(of_sum(there->x))), ry = static_cast<int>(std::lround(of_sum(there->y)));
        for (int dy = -kPatchRows_px; dy <= kPatchRows_px; ++dy) {
          if (!holds_patch(right.size(), rx, ry + dy)) continue;
          const double energy = double{left_energy.at(y, x)} * right_energy.at(ry + dy, rx);
          if (energy > 0) found.push_back({rx, ry + dy, patch_product(left, x, y, right, rx, ry + dy) / std::sqrt(energy)});
        }
      }
      const auto best = std::max_element(found.begin(), found.end(),
                                         [](const Alike& a, const Alike& b) { return a.correlation < b.correlation; });
      if (best == found.end() || best->correlation < kLeastCorrelation) continue;
      const auto nearly = [&](const Alike& a) {
        return std::max(std::abs(a.x - best->x), std::abs(a.y - best->y)) > kElsewhere_px &&
               a.correlation > kMostElsewhere * best->correlation;
      };
      if (std::any_of(found.begin(), found.end(), nearly)) continue;
      constexpr double kPixels = 2 * kPatchRadius_px * (2 * kPatchRadius_px + 1);
      const double noise = std::sqrt((1 - best->correlation) * left_energy.at(y, x) / kPixels);
      const Vec2 from = {double(x), double(y)};
      const auto there = align_match(left, from, sloped, {double(best->x), double(best->y)}, kPatchRadius_px,
                                     {kLeastCorrelation, noise, kMostSigma_px / square});
      if (!there) continue;
      const double sigma_px = square * noise / std::sqrt(double{steep.at(best->y, best->x)});
      scene.matches.push_back(
          {{given(x), given(y)}, {given(there->x), given(there->y)}, kPointSigma_px / std::max(kPointSigma_px, sigma_px)});
    }
  scene.fewest_points = static_cast<int>(scene.matches.size());
  return scene;
}

}  // namespace duo
