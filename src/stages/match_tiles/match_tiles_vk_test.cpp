#include "stages/match_tiles/match_tiles_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

struct Inputs {
  Image<std::uint8_t> left, right, left_inside, right_inside;
  TileSets sets;
  Image<std::uint32_t> sets32;

  // The right picture is half of it a moved, slightly noisy copy, so that ties, winners and sub-pixel offsets all occur.
  Inputs(Size size, test::Fill how, int max_disparity, std::mt19937& rng)
      : left(size),
        right(size),
        left_inside(size),
        right_inside(size),
        sets(size, max_disparity),
        sets32(TileSets::shape32(size, max_disparity)) {
    test::fill(left.view(), how, rng);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const int moved = left.at(y, std::min(x + 4, size.width - 1));
        right.at(y, x) = static_cast<std::uint8_t>(rng() % 2 ? moved : std::min(255, moved + static_cast<int>(rng() % 9)));
        left_inside.at(y, x) = x > 2 && rng() % 200 ? 255 : 0;
        right_inside.at(y, x) = y > 0 && rng() % 200 ? 255 : 0;
      }
    for (int t = 0; t < sets.words.height(); ++t)
      for (int d = 0; d < max_disparity; ++d)
        if (rng() % 3) {
          TileSets::add(sets.words.row(t), d);
          sets32.at(t, d / 32) |= 1U << (d % 32);
        }
  }
};

struct MatchTilesCase {
  Size size;
  test::Fill how;
  bool masked, all;  // all: no sets
  int max_disparity;
};

class MatchTilesOnDevice {
 public:
  explicit MatchTilesOnDevice(vk::Device& device)
      : device_(device), match_(must(vk::MatchTiles::make(device))), recorder_(must(vk::Recorder::make(device))) {}

  void expect_agrees(const MatchTilesCase& c, const std::string& what) {
    Inputs of(c.size, c.how, c.max_disparity, rng_);
    if (c.all)
      for (int t = 0; t < of.sets.words.height(); ++t)
        for (int d = 0; d < c.max_disparity; ++d) TileSets::add(of.sets.words.row(t), d);
    GrayPair pair{of.left, of.right};
    if (c.masked) pair.left_inside = of.left_inside, pair.right_inside = of.right_inside;
    MatchTilesParams params;
    params.wide_shifts = rng_() % 2;
    if (rng_() % 2) params.truncation = 5, params.sobel_clip = 30;
    Image<std::int16_t> want_left(c.size), want_right(c.size);
    Image<std::uint16_t> want_fine(c.size);
    ref::match_tiles(pair, of.sets, params, {want_left, want_right, want_fine});

    const OnDevice<std::uint8_t> left(device_, of.left, "left"), right(device_, of.right, "right");
    const OnDevice<std::uint8_t> left_inside(device_, of.left_inside, "left inside"),
        right_inside(device_, of.right_inside, "right inside");
    const OnDevice<std::uint32_t> sets(device_, of.sets32, "sets");
    const OnDevice<std::int16_t> out_left(device_, c.size, "out left"), out_right(device_, c.size, "out right");
    const OnDevice<std::uint16_t> fine(device_, c.size, "fine");
    vk::MatchTiles::Input in{.left = left.view(), .right = right.view(), .max_disparity = c.max_disparity};
    if (c.masked) in.left_inside = left_inside.view(), in.right_inside = right_inside.view();
    if (!c.all) in.sets = sets.view();
    const auto scratch = must(vk::MatchTiles::Scratch::make(device_, c.size));
    test::run_with(
        recorder_,
        [&] {
          match_.record_channels(recorder_, in, params, scratch);
          match_.record(recorder_, in, params, scratch, {out_left.view(), out_right.view(), fine.view()});
        },
        left, right, left_inside, right_inside, sets, out_left, out_right, fine);
    test::expect_same<std::int16_t>(want_left, out_left.pixels(what), what + " left");
    test::expect_same<std::int16_t>(want_right, out_right.pixels(what), what + " right");
    test::expect_same<std::uint16_t>(want_fine, fine.pixels(what), what + " fine");
  }

 private:
  vk::Device& device_;
  vk::MatchTiles match_;
  vk::Recorder recorder_;
  std::mt19937 rng_{13};
};

TEST(MatchTilesVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    MatchTilesOnDevice match(device);
    std::size_t turn = 0;
    for (const Size size : {Size{1, 1}, {2, 3}, {15, 4}, {33, 6}, {47, 15}, {48, 16}, {49, 17}, {131, 37}})
      for (const bool masked : {false, true})
        for (const int max_disparity : {1, 7, 70}) {
          const test::Fill how = test::kFills[turn++ % std::size(test::kFills)];
          const std::string what = "match_tiles N " + std::to_string(max_disparity) + (masked ? " masked" : "") + where;
          match.expect_agrees({size, how, masked, turn % 4 == 0, max_disparity}, what);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
