#include "stages/check_left_right/check_left_right_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

struct Pictures {
  Image<std::int16_t> left, right;
  Image<std::uint8_t> left_inside, right_inside;
  Image<std::uint16_t> fine;
  // Few different disparities, so that about half of them pass; holes in all pictures.
  Pictures(Size size, std::mt19937& rng) : left(size), right(size), left_inside(size), right_inside(size), fine(size) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.at(y, x) = static_cast<std::int16_t>(static_cast<int>(rng() % 12) - 1);
        right.at(y, x) = static_cast<std::int16_t>(static_cast<int>(rng() % 12) - 1);
        left_inside.at(y, x) = rng() % 8 == 0 ? 0 : 255;
        right_inside.at(y, x) = rng() % 8 == 0 ? 0 : 255;
        fine.at(y, x) = static_cast<std::uint16_t>(rng());
      }
  }
};

void expect_agrees(vk::Device& device, const vk::CheckLeftRight& check, vk::Recorder& recorder, Size size, bool masked,
                   int tolerance, int reach, const std::string& where, std::mt19937& rng) {
  const Pictures of(size, rng);
  duo::CheckLeftRight in{.left = of.left, .right = of.right, .tolerance = tolerance, .reach = reach};
  if (masked) in.left_inside = of.left_inside, in.right_inside = of.right_inside;
  Image<std::int16_t> want_winners(size);
  Image<std::uint16_t> want(size);
  ref::check_winners(in, want_winners);
  ref::check_left_right(in, of.fine, want);

  const OnDevice<std::int16_t> left(device, of.left, "left"), right(device, of.right, "right"),
      winners(device, size, "winners");
  const OnDevice<std::uint8_t> li(device, of.left_inside, "left inside"), ri(device, of.right_inside, "right inside");
  const OnDevice<std::uint16_t> fine(device, of.fine, "fine"), out(device, size, "dst");
  vk::CheckLeftRight::Input input{.left = left.view(), .right = right.view(), .tolerance = tolerance, .reach = reach};
  if (masked) input.left_inside = li.view(), input.right_inside = ri.view();
  test::run_with(
      recorder,
      [&] {
        check.record_winners(recorder, input, winners.view(), size);
        check.record(recorder, input, fine.view(), out.view(), size);
      },
      left, right, winners, li, ri, fine, out);
  test::expect_same<std::int16_t>(want_winners, winners.pixels("check_winners" + where), "check_winners" + where);
  test::expect_same<std::uint16_t>(want, out.pixels("check_left_right" + where), "check_left_right" + where);
}

TEST(CheckLeftRightVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(7);
    const auto check = must(vk::CheckLeftRight::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : test::awkward_sizes())
      for (const bool masked : {false, true})
        for (const auto& [tolerance, reach] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{2, 4}}) {
          expect_agrees(device, check, recorder, size, masked, tolerance, reach, where, rng);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
