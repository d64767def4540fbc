#include "stages/speckle/speckle_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

struct SpeckleCase {
  Size size;
  unsigned levels;  // few: large islands, crossing each other
  int smallest;
};

// 20 apart: of another island with a step of 16; 0 .. 2 more: of the same one, and sometimes just beyond a step of 1.
Image<std::uint16_t> patches(const SpeckleCase& c, std::mt19937& rng) {
  Image<std::uint16_t> out(c.size);
  for (int y = 0; y < c.size.height; ++y)
    for (int x = 0; x < c.size.width; ++x)
      out.at(y, x) = rng() % 6 == 0 ? Disparity::kNone : static_cast<std::uint16_t>(20 * (rng() % c.levels) + rng() % 3);
  return out;
}

/// One island that winds through the whole picture, a pixel wide: the longest way up there is.
Image<std::uint16_t> serpent(Size size) {
  Image<std::uint16_t> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out.at(y, x) = x % 2 == 0 || y == (x % 4 == 1 ? size.height - 1 : 0) ? 100 : Disparity::kNone;
  return out;
}

TEST(RemoveSpeckleVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(9);
    const auto stage = must(vk::RemoveSpeckle::make(device));
    auto recorder = must(vk::Recorder::make(device));
    const auto expect_agrees = [&](const Image<std::uint16_t>& src, int step_q4, int smallest) {
      const Size size = src.size();
      auto want = src.clone();
      ref::remove_speckle(want, step_q4, smallest);
      const auto scratch = must(vk::RemoveSpeckle::Scratch::make(device, size));
      const OnDevice<std::uint16_t> d(device, src, "d_q4");
      const std::string what = "speckle step " + std::to_string(step_q4) + " smallest " + std::to_string(smallest) + where;
      test::run_with(
          recorder, [&] { stage.record(recorder, d.view(), step_q4, smallest, scratch, size); }, d);
      test::expect_same<std::uint16_t>(want, d.pixels(what), what);
    };
    for (const Size size : {Size{1, 1}, Size{2, 3}, Size{33, 6}, Size{129, 10}, Size{300, 70}})
      for (const unsigned levels : {1U, 2U, 4U, 40U})
        for (const int smallest : {1, 7, 50})
          for (const int step_q4 : {1, 16}) {
            expect_agrees(patches({size, levels, smallest}, rng), step_q4, smallest);
            if (::testing::Test::HasFailure()) return;
          }
    const Image<std::uint16_t> long_one = serpent({261, 50});
    expect_agrees(long_one, 16, 261 * 50 / 2 + 1);
    expect_agrees(long_one, 16, 261 * 50);
  });
}

}  // namespace
}  // namespace duo
