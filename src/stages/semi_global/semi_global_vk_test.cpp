#include "stages/semi_global/semi_global_vk.h"

#include "stages/match_planes/match_planes.h"
#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

/// A view's planes as the device has them.
Image<std::uint32_t> packed(const duo::MatchPlanes& planes) {
  const Size size = planes.size();
  Image<std::uint32_t> out({size.width, 3 * size.height});
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const auto word = [&](const auto& channels, View<const std::uint8_t> last) {
        return channels[0].at(y, x) | channels[1].at(y, x) << 8 | channels[2].at(y, x) << 16 |
               static_cast<std::uint32_t>(last.at(y, x)) << 24;
      };
      out.at(y, x) = word(planes.value, planes.outside);
      out.at(size.height + y, x) = word(planes.low, planes.census[0]);
      out.at(2 * size.height + y, x) = word(planes.high, planes.census[1]);
    }
  return out;
}

struct SemiGlobalCase {
  Size size;
  int max_disparity;
  SemiGlobalParams params;
  bool masked = false, margin = true;
  test::Fill how = test::Fill::kRandom;
};

SemiGlobalParams paths(int count) {
  SemiGlobalParams params;
  params.diagonals = count == 5 || count == 8;
  params.upward = count == 4 || count == 8;
  return params;
}

/// Greatest costs and penalties: nothing wraps.
SemiGlobalParams bounds() {
  SemiGlobalParams params = paths(8);
  params.census_truncation = 16;
  params.truncation = 32;
  params.p1 = params.p2 = params.p2_least = 112;
  return params;
}

/// The planes of two views, the right one a shifted and spoilt left one.
struct Planes {
  PlaneImages left, right;
  Planes(const SemiGlobalCase& c, std::mt19937& rng)
      : left(c.size, simd::SemiGlobalScratch::padding(c.max_disparity)), right(c.size, left.pad) {
    Image<std::uint8_t> l(c.size), r(c.size), inside(c.size);
    test::fill(l.view(), c.how, rng);
    for (int y = 0; y < c.size.height; ++y)
      for (int x = 0; x < c.size.width; ++x) {
        r.at(y, x) = rng() % 4 ? l.at(y, std::min(c.size.width - 1, x + 3)) : static_cast<std::uint8_t>(rng());
        inside.at(y, x) = rng() % 11 ? 255 : 0;
      }
    const auto mask = c.masked ? View<const std::uint8_t>(inside) : View<const std::uint8_t>{};
    ref::match_planes(l, mask, 0, false, left);
    ref::match_planes(r, mask, 0, false, right);
  }
};

void expect_agrees(vk::Device& device, vk::Recorder& recorder, const SemiGlobalCase& c, const std::string& where) {
  std::mt19937 rng(31);
  const auto stage = must(vk::SemiGlobal::make(device, c.max_disparity, c.params));
  const auto scratch = must(vk::SemiGlobal::Scratch::make(device, c.size, c.max_disparity, c.params));
  for (int frame = 0; frame < 2; ++frame) {  // the second must not see anything of the first
    const Planes planes(c, rng);
    Image<std::int16_t> left(c.size), right(c.size);
    Image<std::uint16_t> fine(c.size);
    Image<std::uint8_t> margin(c.size);
    ref::semi_global({planes.left.planes(), planes.right.planes(), c.max_disparity, c.params}, {left, right, fine, margin});

    const auto packed_left = packed(planes.left.planes()), packed_right = packed(planes.right.planes());
    const OnDevice<std::uint32_t> l(device, packed_left, "left"), r(device, packed_right, "right");
    const OnDevice<std::int16_t> got_left(device, c.size, "left winner"), got_right(device, c.size, "right winner");
    const OnDevice<std::uint16_t> got_fine(device, c.size, "fine");
    const OnDevice<std::uint8_t> got_margin(device, c.size, "margin");
    vk::SemiGlobal::Match match{got_left.view(), got_right.view(), got_fine.view()};
    if (c.margin) match.margin = got_margin.view();
    test::run_with(
        recorder, [&] { stage.record(recorder, l.view(), r.view(), scratch, match, c.size); }, l, r, got_left, got_right,
        got_fine, got_margin);
    const std::string what =
        "semi_global N " + std::to_string(c.max_disparity) + " paths " + std::to_string(c.params.paths()) + where;
    if (!test::expect_same<std::int16_t>(left, got_left.pixels(what), what + " left") ||
        !test::expect_same<std::int16_t>(right, got_right.pixels(what), what + " right") ||
        !test::expect_same<std::uint16_t>(fine, got_fine.pixels(what), what + " fine"))
      return;
    if (c.margin && !test::expect_same<std::uint8_t>(margin, got_margin.pixels(what), what + " margin")) return;
  }
}

TEST(SemiGlobalVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    auto recorder = must(vk::Recorder::make(device));
    for (const SemiGlobalCase& c :
         {SemiGlobalCase{{1, 1}, 1, paths(8)}, SemiGlobalCase{{7, 5}, 3, paths(3), true},
          SemiGlobalCase{{33, 17}, 16, paths(4)}, SemiGlobalCase{{17, 33}, 16, paths(5), true, false},
          SemiGlobalCase{{33, 17}, 37, paths(8), true}, SemiGlobalCase{{64, 20}, 64, paths(3), false, false},
          SemiGlobalCase{{40, 6}, 128, paths(8)}, SemiGlobalCase{{70, 5}, 129, paths(3), true},
          SemiGlobalCase{{31, 4}, 256, paths(3)}, SemiGlobalCase{{31, 12}, 24, bounds(), true, true, test::Fill::kCheckerboard},
          SemiGlobalCase{{20, 12}, 24, bounds()}, SemiGlobalCase{{20, 6}, 64, paths(3), false, true, test::Fill::kConstant}}) {
      if (test::assisted() && c.size.width * c.max_disparity > 600) continue;
      expect_agrees(device, recorder, c, where);
      if (::testing::Test::HasFailure()) return;
    }
  });
}

TEST(SemiGlobalVk, TooLargeVolumeIsSaid) {
  test::each_device([](vk::Device& device, const std::string&) {
    const auto scratch = vk::SemiGlobal::Scratch::make(device, {1280, 720}, 256, {});
    ASSERT_FALSE(scratch);
    EXPECT_NE(scratch.error().what.find("1280x720"), std::string::npos) << scratch.error().what;
    EXPECT_NE(scratch.error().what.find("at most 144 disparities"), std::string::npos) << scratch.error().what;
  });
}

}  // namespace
}  // namespace duo
