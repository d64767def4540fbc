#include "stages/mark_invalid/mark_invalid_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

void expect_agrees(vk::Device& device, const vk::MarkInvalid& mark, vk::Recorder& recorder, Size size, bool masked,
                   const std::string& what, std::mt19937& rng) {
  Image<std::int16_t> winner(size);
  Image<std::uint8_t> left_inside(size), right_inside(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      winner.at(y, x) = static_cast<std::int16_t>(rng() % 8 == 0 ? static_cast<int>(rng()) : static_cast<int>(rng() % 50) - 5);
      left_inside.at(y, x) = rng() % 4 == 0 ? 0 : 255;
      right_inside.at(y, x) = rng() % 4 == 0 ? 0 : 255;
    }
  constexpr int kMaxDisparity = 40;
  const auto inside = [&](const Image<std::uint8_t>& image) { return masked ? image.view() : View<const std::uint8_t>(); };
  Image<std::uint16_t> want(size);
  ref::mark_invalid(winner, inside(left_inside), inside(right_inside), kMaxDisparity, want);

  const OnDevice<std::int16_t> winners(device, winner, "winner");
  const OnDevice<std::uint8_t> left(device, left_inside, "left inside"), right(device, right_inside, "right inside");
  const OnDevice<std::uint16_t> out(device, size, "dst");
  vk::MarkInvalid::Input in{.winner = winners.view(), .max_disparity = kMaxDisparity};
  if (masked) in.left_inside = left.view(), in.right_inside = right.view();
  test::run_with(
      recorder, [&] { mark.record(recorder, in, out.view(), size); }, winners, left, right, out);
  test::expect_same<std::uint16_t>(want, out.pixels(what), what);
}

TEST(MarkInvalidVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(5);
    const auto mark = must(vk::MarkInvalid::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : test::awkward_sizes())
      for (const bool masked : {false, true}) {
        expect_agrees(device, mark, recorder, size, masked, std::string("mark_invalid") + (masked ? " masked" : "") + where,
                      rng);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
