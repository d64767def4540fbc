// What stands still behind the person: depth and colour of each cell while nobody is before it.
#pragma once

#include <cstdint>
#include <vector>

#include "trackers/arm/regions.h"

namespace duo::arm {

/// Depth alone cannot tell a bare wall beside the arm, to which stereo gives the arm's depth: its colour is still the wall's.
class Background {
 public:
  Background() = default;
  explicit Background(const Grid& grid);

  /// Learns from one frame; cells set in `unknown` and those near them show the person and are guessed from their surroundings.
  void start(const Grid& grid, const std::vector<std::uint8_t>& unknown);
  /// Before front(): how the light changed since, and which cells kept their colour.
  void observe(const Grid& grid);
  /// After it: learns what was not in front.
  void update(const Grid& grid);

  /// Whether the cell shows something before the background.
  bool front(const Grid& grid, int i) const { return !same_color_[static_cast<std::size_t>(i)] && nearer(grid, i); }

 private:
  enum class Known : std::uint8_t { kNothing, kGuessed, kSeen };
  void guess_depth(const Grid& grid);
  void guess_color(const Grid& grid);
  bool nearer(const Grid& grid, int i) const;
  bool is_reference(const Grid& grid, int i) const;
  float color_step(const Grid& grid, int i) const;
  void observe_light(const Grid& grid);

  std::vector<float> d_px_;                // disparity in cells; 0 = unknown
  std::vector<std::uint8_t> depth_known_;  // 1: seen, not guessed
  std::vector<Rgb> color_;
  std::vector<Known> color_known_;
  std::vector<std::uint8_t> same_, same_color_;
  Rgb gain_{1, 1, 1};      // the light now against color_
  float color_limit_ = 6;  // levels; more is another surface
  std::vector<float> samples_[3];
};

}  // namespace duo::arm
