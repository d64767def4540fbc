#include "stages/match_tiles/match_tiles.h"

#include "tests/agree.h"

namespace duo {
namespace {

struct Maps {
  Image<std::int16_t> left, right;
  Image<std::uint16_t> fine;
  explicit Maps(Size size) : left(size), right(size), fine(size) {}
  TileMatch out() { return {left, right, fine}; }
};

TileSets all_of(Size size, int max_disparity) {
  TileSets sets(size, max_disparity);
  for (int t = 0; t < sets.words.height(); ++t)
    for (int d = 0; d < max_disparity; ++d) TileSets::add(sets.words.row(t), d);
  return sets;
}

// The right picture is the left one moved by five pixels: both views find 5, and symmetric costs give no sub-pixel offset
// beyond what noise-free neighbours leave.
TEST(MatchTiles, FindsAShiftInBothViews) {
  std::mt19937 rng(11);
  Image<std::uint8_t> left({120, 40}), right({120, 40});
  test::fill(left.view(), test::Fill::kRandom, rng);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 120; ++x) right.at(y, x) = left.at(y, std::min(x + 5, 119));
  Maps got(left.size());
  ref::match_tiles({left, right}, all_of(left.size(), 16), {}, got.out());
  for (int y = 0; y < 40; ++y)
    for (int x = 20; x < 100; ++x) {
      EXPECT_EQ(got.left.at(y, x), 5);
      EXPECT_EQ(got.right.at(y, x), 5);
      EXPECT_NEAR(got.fine.at(y, x), 80, 8);
    }
  EXPECT_LE(got.left.at(20, 0), 0) << "x = 0 can only have d = 0";
}

// By hand: flat left 100 against flat right 90, no gradients: each pixel costs |50 - 45| = 5, each window 245, every d ties: 0
// wins, and a V through equal costs has no tip.
TEST(MatchTiles, TieGoesToTheSmallest) {
  const auto left = test::constant<std::uint8_t>({60, 20}, 100), right = test::constant<std::uint8_t>({60, 20}, 90);
  Maps got(left.size());
  ref::match_tiles({left, right}, all_of(left.size(), 8), {}, got.out());
  EXPECT_EQ(got.left.at(10, 30), 0);
  EXPECT_EQ(got.fine.at(10, 30), 0);
  EXPECT_EQ(got.right.at(10, 30), 0);
}

// Only what is in the tile's set is found; a tile with an empty set finds nothing.
TEST(MatchTiles, KeepsToItsCandidates) {
  std::mt19937 rng(12);
  Image<std::uint8_t> left({100, 16}), right({100, 16});
  test::fill(left.view(), test::Fill::kRandom, rng);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 100; ++x) right.at(y, x) = left.at(y, std::min(x + 5, 99));
  TileSets sets(left.size(), 16);
  TileSets::add(sets.of(0, 1), 3);
  TileSets::add(sets.of(0, 1), 7);
  Maps got(left.size());
  ref::match_tiles({left, right}, sets, {}, got.out());
  EXPECT_EQ(got.left.at(8, 20), -1);
  EXPECT_EQ(got.fine.at(8, 20), Disparity::kNone);
  EXPECT_TRUE(got.left.at(8, 70) == 3 || got.left.at(8, 70) == 7);
  EXPECT_EQ(got.fine.at(8, 70), 16 * got.left.at(8, 70)) << "no neighbours, no sub-pixel";
}

void agree(const GrayPair& pair, const TileSets& sets, const MatchTilesParams& params, const std::string& what) {
  static Pool one(1), two(2), three(3);
  Maps want(pair.size());
  ref::match_tiles(pair, sets, params, want.out());
  test::each_target([&](const std::string& target) {
    for (Pool* pool : {&one, &two, &three}) {
      Maps got(pair.size());
      simd::MatchTilesScratch scratch(pair.size(), sets.max_disparity, pool->threads());
      simd::match_tiles(*pool, pair, sets, params, scratch, got.out());
      const std::string who = what + " simd " + target + " threads " + std::to_string(pool->threads());
      test::expect_same<std::int16_t>(want.left, got.left, who + " left");
      test::expect_same<std::int16_t>(want.right, got.right, who + " right");
      test::expect_same<std::uint16_t>(want.fine, got.fine, who + " fine");
    }
  });
}

TEST(MatchTiles, SimdAgrees) {
  std::mt19937 rng(13);
  std::size_t turn = 0;
  auto sizes = test::awkward_sizes();
  sizes.insert(sizes.end(), {{47, 15}, {48, 16}, {49, 17}, {96, 33}, {100, 50}});
  for (const Size size : sizes)
    for (const bool masked : {false, true})
      for (const int max_disparity : {1, 7, 64, 70}) {
        const test::Fill how = test::kFills[turn++ % std::size(test::kFills)];  // in the end each with each number
        test::Tight<std::uint8_t> left(size), right(size), left_inside(size), right_inside(size);
        test::fill(left.view, how, rng);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            // Half of it a moved, slightly noisy copy, so that ties, winners and sub-pixel offsets all occur.
            const int moved = left.view.at(y, std::min(x + 4, size.width - 1));
            right.view.at(y, x) =
                static_cast<std::uint8_t>(rng() % 2 ? moved : std::min(255, moved + static_cast<int>(rng() % 9)));
            left_inside.view.at(y, x) = x > 2 && rng() % 200 ? 255 : 0;
            right_inside.view.at(y, x) = y > 0 && rng() % 200 ? 255 : 0;
          }
        TileSets sets(size, max_disparity);
        for (int t = 0; t < sets.words.height(); ++t)
          for (int d = 0; d < max_disparity; ++d)
            if (rng() % 3) TileSets::add(sets.words.row(t), d);
        GrayPair pair{left.view, right.view};
        if (masked) pair.left_inside = left_inside.view, pair.right_inside = right_inside.view;
        MatchTilesParams params;
        params.wide_shifts = rng() % 2;
        if (rng() % 2) params.truncation = 5, params.sobel_clip = 30;
        agree(pair, sets, params, "match_tiles N " + std::to_string(max_disparity) + (masked ? " masked" : ""));
        if (HasFailure()) return;
      }
}

}  // namespace
}  // namespace duo
