#include "stages/tile_candidates/tile_candidates_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

/// The same bits in words of 32.
Image<std::uint32_t> halves_of(TileSets& sets, Size shape) {
  Image<std::uint32_t> out(shape);
  for (int t = 0; t < shape.height; ++t)
    for (int i = 0; i < shape.width; ++i) out.at(t, i) = static_cast<std::uint32_t>(sets.words.at(t, i / 2) >> (32 * (i % 2)));
  return out;
}

void expect_agrees(vk::Device& device, const vk::TileCandidates& candidates, vk::Recorder& recorder, Size size,
                   int max_disparity, unsigned share, const std::string& what, std::mt19937& rng) {
  const Size coarse{(size.width + 1) / 2, (size.height + 1) / 2}, shape = TileSets::shape32(size, max_disparity);
  Image<std::int16_t> checked(coarse), unchecked(coarse);
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      unchecked.at(y, x) =
          static_cast<std::int16_t>(static_cast<int>(rng() % static_cast<unsigned>((max_disparity + 1) / 2 + 1)) - 1);
      checked.at(y, x) = rng() % 100 < share ? unchecked.at(y, x) : std::int16_t{-1};
    }
  const int grow = static_cast<int>(rng() % 3), margin = static_cast<int>(rng() % 5);
  TileSets want(size, max_disparity);
  ref::tile_candidates({checked, unchecked, grow, margin}, want);

  const OnDevice<std::int16_t> c(device, checked, "checked"), u(device, unchecked, "unchecked");
  const OnDevice<std::uint32_t> sets(device, shape, "sets");
  test::run_with(
      recorder,
      [&] {
        candidates.record(recorder, {c.view(), u.view(), grow, margin}, sets.view(), size, max_disparity);
      },
      c, u, sets);
  test::expect_same<std::uint32_t>(halves_of(want, shape), sets.pixels(what), what);
}

TEST(TileCandidatesVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(15);
    const auto candidates = must(vk::TileCandidates::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, {47, 15}, {49, 17}, {131, 67}, {300, 40}})
      for (const int max_disparity : {1, 2, 31, 63, 64, 65, 200})
        for (const unsigned share : {0U, 1U, 50U}) {
          expect_agrees(device, candidates, recorder, size, max_disparity, share, "tile_candidates" + where, rng);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
