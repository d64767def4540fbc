// The second opinion of the thesis: points stored around each joint, found again in its window.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/pool.h"
#include "stages/match_points/match_points.h"
#include "stages/sift/sift.h"
#include "trackers/thesis/observation.h"

namespace duo::thesis {

class PointFinder {
 public:
  PointFinder() = default;
  explicit PointFinder(Size largest_window);

  JointPoints learn(Pool& pool, const Image<std::uint8_t>& gray, const Window& window, PlaceQ4 joint);
  /// Which of the stored points are seen in the window; seen() tells where.
  std::span<const PointMatch> find(Pool& pool, const Image<std::uint8_t>& gray, const Window& window,
                                   const JointPoints& stored);
  const SiftPoints& seen() const { return seen_; }

 private:
  SiftParams params_;
  std::optional<SiftScratch> scratch_;
  SiftPoints seen_;
  std::vector<PointMatch> matches_;
};

}  // namespace duo::thesis
