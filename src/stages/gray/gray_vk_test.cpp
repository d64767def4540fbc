#include "stages/gray/gray_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(GrayVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto gray = must(vk::Gray::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : test::awkward_sizes()) {
      Image<Rgb8> src(size);
      Image<std::uint8_t> want(size);
      test::fill(test::channels(src), test::Fill::kRandom, rng);
      src.at(0, 0) = {255, 255, 255};
      ref::gray(src, want);
      const OnDevice<Rgb8> in(device, src, "src");
      const OnDevice<std::uint8_t> out(device, size, "dst");
      test::run_with(
          recorder, [&] { gray.record(recorder, in.view(), out.view(), size); }, in, out);
      test::expect_same<std::uint8_t>(want, out.pixels("gray" + where), "gray" + where);
      if (::testing::Test::HasFailure()) return;
    }
  });
}

}  // namespace
}  // namespace duo
