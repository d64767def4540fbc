#include "trackers/arm/thesis_blob.h"

#include <cmath>

#include "core/check.h"
#include "stages/erode/erode.h"
#include "stages/hsv/hsv.h"
#include "stages/mark_targets/mark_targets.h"
#include "stages/region/region.h"
#include "stages/sums/sums.h"

namespace duo::arm {
namespace {

constexpr std::uint8_t kHueTolerance = 8, kLeastSaturation = 40, kLeastValue = 40;
constexpr int kClickRadiusShare = 100;  // of the picture's width: 6 px of 640
constexpr int kWindowShare = 6;         // likewise: 107 px of 640, a fast hand's way in a few frames
constexpr int kLeastPixels = 12;

Pixel pixel_at(Vec2 at_px) {
  return {static_cast<std::int32_t>(std::lround(at_px.y)), static_cast<std::int32_t>(std::lround(at_px.x))};
}

}  // namespace

BlobFinder::BlobFinder(Size size) : hue_(size), saturation_(size), value_(size), marks_(size), eroded_(size), forest_(size) {}

void BlobFinder::look_at(Pool& pool, const Frame& frame) {
  simd::hsv(pool, frame.color.view(), {hue_.view(), saturation_.view(), value_.view()});
}

Window BlobFinder::window_at(Vec2 at_px) const {
  const int side = hue_.width() / kWindowShare;
  const Pixel p = pixel_at(at_px);
  return {p.x - side / 2, p.y - side / 2, side, side};
}

std::optional<Blob> BlobFinder::learn(Pool& pool, Vec2 click_px) {
  const Pixel p = pixel_at(click_px);
  const Area around{Window::all(hue_.size()), {p.x, p.y, hue_.width() / kClickRadiusShare}};
  const auto hue = mean_hue(simd::sums(pool, {hue_.size(), around, hue_.view(), {}}));
  if (!hue) return {};
  const Blob blob{click_px, *hue};
  const Target target = target_of(blob);
  simd::mark_targets(pool, {hue_.view(), saturation_.view(), value_.view(), {}, {}, {&target, 1}}, marks_.view());
  const Area fitting{around.window, around.disc, marks_.view(), 1};
  if (simd::sums(pool, {hue_.size(), fitting, {}, {}}).count == 0) return {};
  return blob;
}

Target BlobFinder::target_of(const Blob& blob) const {
  return {{blob.hue, kHueTolerance, kLeastSaturation, kLeastValue}, {}, window_at(blob.at_px)};
}

void BlobFinder::find(Pool& pool, std::span<Blob> blobs, std::array<bool, kMaxTargets>& found) {
  DUO_CHECK(blobs.size() <= kMaxTargets);
  std::array<Target, kMaxTargets> targets;
  for (std::size_t i = 0; i < blobs.size(); ++i) targets[i] = target_of(blobs[i]);
  simd::mark_targets(pool, {hue_.view(), saturation_.view(), value_.view(), {}, {}, {targets.data(), blobs.size()}},
                     marks_.view());
  simd::erode(pool, marks_.view(), Neighbours::kFour, eroded_.view());
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    const int bit = static_cast<int>(i);
    const Window window = targets[i].window;
    simd::keep_region(pool, {bit, window, duo::Region::Pick::kNearest, pixel_at(blobs[i].at_px)}, eroded_.view(), forest_);
    const AreaSums sums =
        simd::sums(pool, {hue_.size(), {window, {}, eroded_.view(), static_cast<std::uint8_t>(1 << bit)}, hue_.view(), {}});
    found[i] = sums.count >= kLeastPixels;
    if (!found[i]) continue;
    const auto n = static_cast<double>(sums.count);
    blobs[i] = {{static_cast<double>(sums.x) / n, static_cast<double>(sums.y) / n}, mean_hue(sums).value_or(blobs[i].hue)};
  }
}

}  // namespace duo::arm
