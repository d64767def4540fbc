// A joint as the thesis sees it: a patch of one hue.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/pool.h"
#include "core/run_forest.h"
#include "core/targets.h"
#include "duoptic/frame.h"
#include "trackers/arm/pinhole.h"

namespace duo::arm {

/// Where a blob is looked for, and what it looks like.
struct Blob {
  Vec2 at_px;            // of the rectified picture
  std::uint8_t hue = 0;  // 256 = full circle
};

/// The passes that all blobs share.
///
/// Source  the thesis: mark by hue in a window, erode, keep the connected region, sum; the mean hue becomes the new target
class BlobFinder {
 public:
  BlobFinder() = default;
  explicit BlobFinder(Size size);

  /// Converts the frame; before everything else.
  void look_at(Pool& pool, const Frame& frame);
  /// The blob around a click.
  ///
  /// Errors  none where no pixel fits its own model: gray, or too dark
  std::optional<Blob> learn(Pool& pool, Vec2 click_px);
  /// Looks for up to kMaxTargets blobs in one pass; moves those found and adapts their hue. found[i] tells which.
  void find(Pool& pool, std::span<Blob> blobs, std::array<bool, kMaxTargets>& found);

  /// The square around a place in which things are looked for.
  Window window_at(Vec2 at_px) const;

 private:
  Target target_of(const Blob& blob) const;
  Image<std::uint8_t> hue_, saturation_, value_, marks_, eroded_;
  RunForestScratch forest_;
};

}  // namespace duo::arm
