#include "stages/fill/fill_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

// Holes with `share` percent of measured pixels between them; rows without any among them.
Image<std::uint16_t> holes(Size size, unsigned share, std::mt19937& rng) {
  Image<std::uint16_t> out(size);
  for (int y = 0; y < size.height; ++y) {
    const bool empty = rng() % 5 == 0;
    for (int x = 0; x < size.width; ++x)
      out.at(y, x) = !empty && rng() % 100 < share ? static_cast<std::uint16_t>(rng() % 65535) : Disparity::kNone;
  }
  return out;
}

void expect_agrees(vk::Device& device, const vk::Fill& fill, vk::Recorder& recorder, View<const std::uint16_t> d_q4, bool fills,
                   const std::string& what) {
  const Size size = d_q4.size();
  Image<std::uint16_t> want(size);
  for (int y = 0; y < size.height; ++y) std::copy_n(d_q4.row(y), size.width, want.row(y));
  Image<std::uint8_t> want_origin(size);
  ref::mark_measured(want, want_origin);
  if (fills) ref::fill(want, want_origin);

  const OnDevice<std::uint16_t> d(device, d_q4, "d_q4");
  const OnDevice<std::uint8_t> origin(device, size, "origin");
  test::run_with(
      recorder,
      [&] {
        fills ? fill.record(recorder, d.view(), origin.view(), size)
              : fill.record_measured(recorder, d.view(), origin.view(), size);
      },
      d, origin);
  test::expect_same<std::uint16_t>(want, d.pixels(what), what);
  test::expect_same<std::uint8_t>(want_origin, origin.pixels(what), what + " origin");
}

TEST(FillVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(6);
    const auto fill = must(vk::Fill::make(device));
    auto recorder = must(vk::Recorder::make(device));
    auto sizes = test::awkward_sizes();
    sizes.push_back({1000, 2});
    sizes.push_back({16384, 1});
    for (const Size size : sizes)
      for (const unsigned share : {0u, 1u, 30u, 100u})
        for (const bool fills : {false, true}) {
          expect_agrees(device, fill, recorder, holes(size, share, rng), fills, (fills ? "fill" : "mark_measured") + where);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
