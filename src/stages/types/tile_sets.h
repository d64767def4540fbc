// The candidate disparities of each tile of a picture, between the stage that chooses them and the stage that tries them.
#pragma once

#include <cstdint>

#include "duoptic/image.h"

namespace duo {

/// One set a tile, as bits: bit d % 64 of word d / 64.
struct TileSets {
  static constexpr int kWidth = 48, kHeight = 16;  // px; with its margins a tile is 64 wide: whole vectors of bytes everywhere
  static Size tiles_of(Size picture) {
    return {(picture.width + kWidth - 1) / kWidth, (picture.height + kHeight - 1) / kHeight};
  }
  /// Of the same bits in words of 32, as devices keep them: one row a tile.
  static Size shape32(Size picture, int max) {
    const Size tiles = tiles_of(picture);
    return {(max + 31) / 32, tiles.width * tiles.height};
  }

  Size tiles;
  int max_disparity = 0;
  Image<std::uint64_t> words;  // one row a tile, tiles row by row

  TileSets() = default;
  TileSets(Size picture, int max)
      : tiles(tiles_of(picture)), max_disparity(max), words({(max + 63) / 64, tiles.width * tiles.height}) {}
  std::uint64_t* of(int ty, int tx) { return words.row(ty * tiles.width + tx); }
  const std::uint64_t* of(int ty, int tx) const { return words.row(ty * tiles.width + tx); }
  static bool has(const std::uint64_t* set, int d) { return (set[d >> 6] >> (d & 63) & 1) != 0; }
  static void add(std::uint64_t* set, int d) { set[d >> 6] |= std::uint64_t{1} << (d & 63); }
};

}  // namespace duo
