// The pyramid matcher on a device. README.md beside this file tells the method, pyramid_ref.cpp the order of its stages.
#pragma once

#include <optional>
#include <vector>

#include "matchers/match_vk.h"
#include "matchers/pyramid/pyramid.h"
#include "stages/balance/balance_vk.h"
#include "stages/check_left_right/check_left_right_vk.h"
#include "stages/halve/halve_vk.h"
#include "stages/mark_invalid/mark_invalid_vk.h"
#include "stages/match_around/match_around_vk.h"
#include "stages/match_tiles/match_tiles_vk.h"
#include "stages/median/median_vk.h"
#include "stages/speckle/speckle_vk.h"
#include "stages/tile_candidates/tile_candidates_vk.h"

namespace duo::vk {

/// Kernels and memory of the matcher for pictures of one size; must outlive the recordings that use it.
class Pyramid {
 public:
  using Input = MatchInput;
  /// Errors  the device lacks memory, or the driver refuses a kernel
  static Result<Pyramid> make(const Device& device, const PyramidParams& params, const MatchSetup& setup);
  /// Disparity of the left picture in 1/16 px, without confidence; all pictures of the size set up.
  void record(Recorder& recorder, const Input& pair, const MatchOutput& out) const;

 private:
  /// What the balance of brightness needs.
  struct Balanced {
    Balance balance;
    Balance::Scratch scratch;
    Buffer right;
  };
  /// What the thesis's search needs.
  struct Around {
    MatchAround match;
    MarkInvalid mark_invalid;
  };
  /// What the search in tiles needs.
  struct Tiles {
    MatchTiles match;
    CheckLeftRight check;
    TileCandidates candidates;
    Median median;
    RemoveSpeckle speckle;
    RemoveSpeckle::Scratch speckle_scratch;
    Buffer filtered;
  };
  /// The memory of one level; the pictures of level 0 belong to the caller.
  struct Level {
    LevelShape shape;
    Buffer left = {}, right = {}, left_inside = {}, right_inside = {};
    Buffer left_winner = {};
    // Of tiles only.
    Buffer right_winner = {}, checked = {}, fine = {}, sets = {};
    MatchTiles::Scratch scratch = {};
  };
  static Result<Balanced> make_balanced(const Device& device, Size size);
  static Result<Around> make_around(const Device& device);
  static Result<Tiles> make_tiles(const Device& device, Size size);
  Result<Level> make_level(const Device& device, const LevelShape& shape) const;

  Input pair_of(const Input& full, std::size_t level) const;
  void record_halving(Recorder& recorder, const Input& pair) const;
  void record_around(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const;
  void record_tiles(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const;
  MatchTiles::Input tiles_input(const Input& pair, std::size_t level) const;
  MatchTilesParams tiles_params(std::size_t level) const;
  BufferView<std::uint32_t> sets_of(std::size_t level) const;
  void record_candidates(Recorder& recorder, const Input& pair, std::size_t coarser) const;
  void record_checked(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const;

  PyramidParams params_;
  bool masked_ = false;
  std::vector<Level> levels_;
  Halve halve_;
  std::optional<Balanced> balanced_;
  std::optional<Around> around_;  // one of the two
  std::optional<Tiles> tiles_;
};

}  // namespace duo::vk
