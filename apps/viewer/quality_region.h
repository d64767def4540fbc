// The figures of `duoptic quality` for a part of the depth picture that is dragged with the mouse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "duoptic/depth_quality.h"

namespace duo::app::view {

class QualityRegion {
 public:
  /// The wall is at this distance from the left lens; 0: not known.
  void set_distance(double distance_m);
  /// px of the depth picture; an empty region takes it away.
  void choose(const Rectified& rectified, duo::Window region);
  const duo::Window& region() const { return region_; }

  /// The last 40 frames count, at most; one that was added before is passed over.
  void add(const Frame& frame);
  /// Lines of text: figures, or why there are none.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  void start();

  Rectified rectified_;
  duo::Window region_;
  double distance_m_ = 0;
  std::optional<DepthQualityMeter> meter_;
  int frames_ = 0;
  std::optional<std::uint64_t> last_;
  std::vector<std::string> lines_;
};

}  // namespace duo::app::view
