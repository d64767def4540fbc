#include "stages/bilateral/bilateral_vk.h"

#include "stages/types/noise.h"
#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(BilateralVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(7);
    const auto stage = must(vk::Bilateral::make(device));
    auto recorder = must(vk::Recorder::make(device));
    const auto noise = must(vk::Buffer::make(device, "noise", sizeof(std::uint32_t), vk::Memory::kDevice));
    for (const Size size : {Size{1, 1}, Size{2, 3}, Size{16, 8}, Size{17, 9}, Size{131, 37}})
      for (const test::Fill how : test::kFills)
        for (const int noise_q4 : {0, 5, 256}) {
          Image<std::uint8_t> src(size), want(size);
          test::fill(src.view(), how, rng);
          ref::bilateral(src, bilateral_range(noise_q4), want);
          const OnDevice<std::uint8_t> in(device, src, "src"), out(device, size, "dst");
          test::run_with(
              recorder,
              [&] {
                recorder.fill(noise, static_cast<std::uint32_t>(noise_q4));
                stage.record(recorder, in.view(), noise, out.view(), size);
              },
              in, out);
          test::expect_same<std::uint8_t>(want, out.pixels("bilateral"), "bilateral" + where);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
