// Where somebody may stand, by depth alone: the network that finds people misses those whose head the picture's border cuts.
#pragma once

#include <array>
#include <span>

#include "duoptic/detector.h"
#include "duoptic/window.h"
#include "trackers/body/lift.h"

namespace duo::body {

/// Something about as wide and high as a person that stands before what is on one of its sides at least.
///
/// Units  z_m: its mean depth; box_px: around it; cut_above: it reaches over the picture's upper border
struct Upright {
  double z_m = 0;
  Window box_px;
  bool cut_above = false;
};

/// Finds what is upright in a depth map.
///
/// Source  runs of one depth in columns: Badino, Franke, Pfeiffer, "The stixel world - a compact medium level representation of
///         the 3D-world", 2009
class Uprights {
 public:
  /// The 16 nearest at most, the nearest first. Valid until the next call.
  std::span<const Upright> find(const DepthView& depth);

 private:
  static constexpr int kColumns = 48, kMostRows = 96;
  static constexpr std::size_t kMostRuns = 8;  // of a column
  static constexpr std::size_t kMost = 16;
  /// A run of cells in a column. Units  rows of cells
  struct Run {
    int top = 0, bottom = 0;
    double z_m = 0;
  };
  /// Runs side by side. Units  cells
  struct Blob {
    int left = 0, right = 0, top = 0, bottom = 0, runs = 0;
    double z_sum_m = 0;
    Run last;
  };
  void read_cells(const DepthView& depth);
  std::span<const Run> runs_of(const DepthView& depth, int column);
  void add(int column, const Run& run);
  /// Whether a blob has a person's size.
  bool is_person_sized(const DepthView& depth, const Blob& blob) const;
  /// Whether what is beside a blob, from a column of cells to another, lies farther away.
  bool is_farther(const Blob& blob, int from, int to) const;

  int side_px_ = 1, columns_ = 0, rows_ = 0;
  std::array<std::array<double, kMostRows>, kColumns> z_m_ = {};  // 0: unknown
  std::array<Run, kMostRuns> runs_;
  std::array<Blob, kColumns * kMostRuns> blobs_;  // as many as there may be runs
  std::size_t blob_count_ = 0;
  std::array<Upright, kColumns * kMostRuns> found_;
};

/// Where the network of bodies would look for a person that stands there. `above_m`: how much of whom the upper border cuts is
/// out of the picture; of others none.
TurnedSquare region_of(const DepthView& depth, const Upright& upright, double above_m);

}  // namespace duo::body
