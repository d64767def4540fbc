// A joint as the thesis sees it: a patch of one hue.
#pragma once

#include <optional>
#include <span>

#include "core/pool.h"
#include "stages/types/run_forest.h"
#include "trackers/thesis/observation.h"

namespace duo::thesis {

/// The square around a place in which a joint is looked for.
Window joint_window(Size size, PlaceQ4 at);
/// What fits this hue there.
Target blob_target(std::uint8_t hue, const Window& window);

/// The passes that all blobs share.
///
/// Source  the thesis: mark by hue in a window, erode, keep the connected region, sum; the mean hue becomes the new target
class BlobFinder {
 public:
  BlobFinder() = default;
  explicit BlobFinder(Size size);

  /// Converts the frame that learn() and find() work on.
  void begin(Pool& pool, const Frame& frame);
  /// The hue around a click, 256 = full circle.
  ///
  /// Errors  none where no pixel fits its own model: gray, or too dark
  std::optional<std::uint8_t> learn(Pool& pool, Pixel click);
  /// Sums over the region of each joint's colour that is nearest to it, all marked in one pass.
  void find(Pool& pool, std::span<const ExpectedJoint> joints, std::span<AreaSums> colors);

 private:
  Image<std::uint8_t> hue_, saturation_, value_, marks_, eroded_;
  RunForestScratch forest_;
};

}  // namespace duo::thesis
