#include "trackers/thesis/blob.h"

#include "core/check.h"
#include "stages/erode/erode.h"
#include "stages/hsv/hsv.h"
#include "stages/mark_targets/mark_targets.h"
#include "stages/region/region.h"
#include "stages/sums/sums.h"

namespace duo::thesis {
namespace {

constexpr std::uint8_t kHueTolerance = 8, kLeastSaturation = 40, kLeastValue = 40;
constexpr int kClickRadiusShare = 100;  // of the picture's width: 6 px of 640

}  // namespace

Window joint_window(Size size, PlaceQ4 at) {
  const int side = joint_window_px(size);
  const Pixel p = at.pixel();
  return {p.x - side / 2, p.y - side / 2, side, side};
}

Target blob_target(std::uint8_t hue, const Window& window) {
  return {{hue, kHueTolerance, kLeastSaturation, kLeastValue}, window};
}

BlobFinder::BlobFinder(Size size) : hue_(size), saturation_(size), value_(size), marks_(size), eroded_(size), forest_(size) {}

void BlobFinder::begin(Pool& pool, const Frame& frame) {
  simd::hsv(pool, frame.color.view(), {hue_.view(), saturation_.view(), value_.view()});
}

std::optional<std::uint8_t> BlobFinder::learn(Pool& pool, Pixel click) {
  const Area around{Window::all(hue_.size()), {click.x, click.y, hue_.width() / kClickRadiusShare}};
  const auto hue = mean_hue(simd::sums(pool, {hue_.size(), around, hue_.view(), {}}));
  if (!hue) return {};
  const Target target = blob_target(*hue, around.window);
  simd::mark_targets(pool, {hue_.view(), saturation_.view(), value_.view(), {&target, 1}}, marks_.view());
  const Area fitting{around.window, around.disc, marks_.view(), 1};
  if (simd::sums(pool, {hue_.size(), fitting, {}, {}}).count == 0) return {};
  return hue;
}

void BlobFinder::find(Pool& pool, std::span<const ExpectedJoint> joints, std::span<AreaSums> colors) {
  DUO_CHECK(joints.size() <= kMaxTargets && colors.size() >= joints.size());
  std::array<Target, kMaxTargets> targets;
  for (std::size_t i = 0; i < joints.size(); ++i) targets[i] = joints[i].target;
  simd::mark_targets(pool, {hue_.view(), saturation_.view(), value_.view(), {targets.data(), joints.size()}}, marks_.view());
  simd::erode(pool, marks_.view(), Neighbours::kFour, eroded_.view());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const int bit = static_cast<int>(i);
    const Window& window = targets[i].window;
    simd::keep_region(pool, {bit, window, joints[i].at.pixel()}, eroded_.view(), forest_);
    colors[i] =
        simd::sums(pool, {hue_.size(), {window, {}, eroded_.view(), static_cast<std::uint8_t>(1 << bit)}, hue_.view(), {}});
  }
}

}  // namespace duo::thesis
