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

TEST(FillVk, MarksWhatWasMeasured) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(6);
    const auto fill = must(vk::Fill::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : test::awkward_sizes())
      for (const unsigned share : {0u, 30u, 100u}) {
        const auto d_q4 = holes(size, share, rng);
        Image<std::uint8_t> want(size);
        ref::mark_measured(d_q4, want);
        const OnDevice<std::uint16_t> d(device, d_q4, "d_q4");
        const OnDevice<std::uint8_t> origin(device, size, "origin");
        test::run_with(
            recorder, [&] { fill.record_measured(recorder, d.view(), origin.view(), size); }, d, origin);
        if (!test::expect_same<std::uint8_t>(want, origin.pixels("origin" + where), "origin" + where)) return;
      }
  });
}

}  // namespace
}  // namespace duo
