// Block motion between two pictures of one camera.
#pragma once

#include <cstdint>
#include <vector>

#include "duoptic/image.h"

namespace duo::ref {

/// A way from one picture to the next, in 1/16 cells to the right and down. {} = stands still, or not known.
struct Way {
  int x_q4 = 0, y_q4 = 0;
  bool operator==(const Way&) const = default;
  bool moved() const { return x_q4 != 0 || y_q4 != 0; }
};

/// Motion by block matching on cells of step x step pixels, at most some 320 in a row: whole cells by search, a sixteenth by
/// the costs beside the least. Each cell then takes, of the blocks around its own, the way that explains it best, which keeps
/// outlines sharp.
///
/// Memory  allocated by the constructor
/// Source  the search: Jain, Jain, "Displacement measurement and its application in interframe image coding", 1981
class BlockFlow {
 public:
  BlockFlow() = default;
  explicit BlockFlow(Size picture);

  int width() const { return width_; }    // cells
  int height() const { return height_; }  // cells
  int step() const { return step_; }      // pixels of a cell
  /// Takes the next picture.
  void see(const Image<Rgb8>& picture);
  /// Ways from the picture before last to the last one seen; row by row.
  const std::vector<Way>& find();

 private:
  Way search(int block_x, int block_y) const;
  int cost(int x, int y, int was_x, int was_y) const;
  void choose(int block_x, int block_y);
  int cost_of_cell(int x, int y, Way way) const;

  int width_ = 0, height_ = 0, step_ = 1, columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> now_, before_;  // brightness of cells
  std::vector<Way> blocks_, cells_;
};

}  // namespace duo::ref
