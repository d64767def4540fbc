#include "stages/match_around/match_around_vk.h"

#include <array>

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

struct MatchAroundCase {
  Size size;
  test::Fill how;
  bool masked;
  int radius;  // 0: whole row
};

std::vector<MatchAroundCase> cases() {
  std::vector<MatchAroundCase> out;
  // Radius 2 is tried by one invocation a block, a row of 95 in two rounds by sixteen.
  for (const Size size :
       {Size{1, 1}, Size{2, 3}, Size{5, 9}, Size{16, 8}, Size{17, 9}, Size{33, 17}, Size{67, 37}, Size{95, 5}})
    for (const test::Fill how : test::kFills)
      for (const bool masked : {false, true})
        for (const int radius : {0, 2, 3, 12}) {
          const bool big = size.width > 40;
          if (big && (how != test::Fill::kRandom || radius == 12)) continue;  // the reference's time
          out.push_back({size, how, masked, radius});
        }
  return out;
}

// Mostly disparities that lie in the picture, some far beyond either end, up to those whose results wrap in 16 bits.
Image<std::int16_t> random_coarser(Size size, std::mt19937& rng) {
  Image<std::int16_t> out({(size.width + 1) / 2, (size.height + 1) / 2});
  constexpr std::array<int, 4> kFar = {-32768, 32767, -300, 300};
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out.at(y, x) = static_cast<std::int16_t>(rng() % 8 == 0 ? kFar[rng() % 4] : static_cast<int>(rng() % 40) - 10);
  return out;
}

Image<std::uint8_t> random_inside(Size size, std::mt19937& rng) {
  Image<std::uint8_t> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) out.at(y, x) = rng() % 4 == 0 ? 0 : 255;
  return out;
}

void expect_agrees(vk::Device& device, const vk::MatchAround& match, vk::Recorder& recorder, const MatchAroundCase& c,
                   const std::string& what, std::mt19937& rng) {
  Image<std::uint8_t> left(c.size), right(c.size);
  test::fill(left.view(), c.how, rng);
  test::fill(right.view(), c.how, rng);
  const auto left_inside = random_inside(c.size, rng), right_inside = random_inside(c.size, rng);
  const auto coarser = random_coarser(c.size, rng);
  duo::MatchAround in{.left = left, .right = right, .radius = c.radius};
  if (c.masked) in.left_inside = left_inside, in.right_inside = right_inside;
  if (c.radius > 0) in.coarser = coarser;
  Image<std::int16_t> want(c.size);
  ref::match_around(in, want);

  const OnDevice<std::uint8_t> l(device, left, "left"), r(device, right, "right");
  const OnDevice<std::uint8_t> li(device, left_inside, "left inside"), ri(device, right_inside, "right inside");
  const OnDevice<std::int16_t> below(device, coarser, "coarser"), out(device, c.size, "dst");
  vk::MatchAround::Input input{.left = l.view(), .right = r.view(), .radius = c.radius};
  if (c.masked) input.left_inside = li.view(), input.right_inside = ri.view();
  if (c.radius > 0) input.coarser = below.view();
  recorder.begin();
  for (const auto* picture : {&l, &r, &li, &ri}) picture->record_upload(recorder);
  for (const auto* picture : {&below, &out}) picture->record_upload(recorder);
  match.record(recorder, input, out.view(), c.size);
  out.record_download(recorder);
  must(recorder.end());
  must(recorder.run());
  test::expect_same<std::int16_t>(want, out.pixels(what), what);
}

TEST(MatchAroundVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto match = must(vk::MatchAround::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const MatchAroundCase& c : cases()) {
      const std::string what = "match_around radius " + std::to_string(c.radius) + (c.masked ? " masked" : "") + where;
      expect_agrees(device, match, recorder, c, what, rng);
      if (::testing::Test::HasFailure()) return;
    }
  });
}

}  // namespace
}  // namespace duo
