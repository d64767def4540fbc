#include "stages/tile_candidates/tile_candidates.h"

#include "tests/agree.h"

namespace duo {
namespace {

std::vector<int> list(const TileSets& sets, int ty, int tx) {
  std::vector<int> out;
  for (int d = 0; d < sets.max_disparity; ++d)
    if (TileSets::has(sets.of(ty, tx), d)) out.push_back(d);
  return out;
}

// By hand: 96x16 px are two tiles over 48x8 coarse pixels. One checked winner 5 in the first, margin 1: 9 .. 12. It lies within the
// half tile that the second one grows by, as nothing there survived.
TEST(TileCandidates, HandWorked) {
  auto checked = test::constant<std::int16_t>({48, 8}, -1);
  const auto unchecked = test::constant<std::int16_t>({48, 8}, 1);
  checked.at(4, 10) = 5;
  TileSets sets({96, 16}, 12);
  ref::tile_candidates({checked, unchecked}, sets);
  EXPECT_EQ(list(sets, 0, 0), (std::vector<int>{9, 10, 11})) << "12 is not below max_disparity";
  EXPECT_EQ(list(sets, 0, 1), (std::vector<int>{9, 10, 11}));
  checked.at(4, 10) = -1;
  ref::tile_candidates({checked, unchecked}, sets);
  EXPECT_EQ(list(sets, 0, 1), (std::vector<int>{1, 2, 3, 4})) << "nothing checked: the unchecked winners, 2 * 1 - 1 .. 2 * 1 + 2";
}

TEST(TileCandidates, SimdAgrees) {
  std::mt19937 rng(15);
  Pool two(2);
  for (const Size size : {Size{1, 1}, {47, 15}, {49, 17}, {131, 67}, {300, 40}})
    for (const int max_disparity : {1, 2, 63, 64, 65, 200})
      for (const unsigned share : {0u, 1u, 50u}) {
        const Size coarse{(size.width + 1) / 2, (size.height + 1) / 2};
        Image<std::int16_t> checked(coarse), unchecked(coarse);
        for (int y = 0; y < coarse.height; ++y)
          for (int x = 0; x < coarse.width; ++x) {
            unchecked.at(y, x) = static_cast<std::int16_t>(static_cast<int>(rng() % static_cast<unsigned>((max_disparity + 1) / 2 + 1)) - 1);
            checked.at(y, x) = rng() % 100 < share ? unchecked.at(y, x) : std::int16_t{-1};
          }
        TileSets want(size, max_disparity), got(size, max_disparity);
        const TileCandidates in{checked, unchecked};
        ref::tile_candidates(in, want);
        simd::tile_candidates(two, in, got);
        test::expect_same<std::uint64_t>(want.words, got.words, "tile_candidates simd");
      }
}

}  // namespace
}  // namespace duo
