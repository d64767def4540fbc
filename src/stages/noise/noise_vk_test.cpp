#include "stages/noise/noise_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(NoiseVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(7);
    const auto stage = must(vk::Noise::make(device));
    const auto scratch = must(vk::Noise::make_scratch(device));
    auto recorder = must(vk::Recorder::make(device));
    const auto noise = must(vk::Buffer::make(device, "noise", sizeof(std::uint32_t), vk::Memory::kDevice));
    const auto found = must(vk::Buffer::make(device, "noise found", sizeof(std::uint32_t), vk::Memory::kDownload));
    for (const Size size : {Size{1, 1}, Size{9, 40}, Size{10, 10}, Size{131, 75}})
      for (const int spread : {0, 3, 9, 60, 235}) {
        Image<std::uint8_t> left(size), right(size);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            left.at(y, x) = static_cast<std::uint8_t>(20 + rng() % static_cast<unsigned>(spread + 1));
            right.at(y, x) = static_cast<std::uint8_t>(100 + rng() % 2);
          }
        const OnDevice<std::uint8_t> l(device, left, "left"), r(device, right, "right");
        test::run_with(
            recorder,
            [&] {
              stage.record(recorder, l.view(), r.view(), scratch, noise, size);
              recorder.copy(noise, found, sizeof(std::uint32_t));
            },
            l, r);
        std::uint32_t got = 0;
        std::memcpy(&got, found.mapped().data(), sizeof(got));
        EXPECT_EQ(static_cast<int>(got), ref::noise_q4(left, right)) << size.width << "x" << size.height << where;
      }
  });
}

}  // namespace
}  // namespace duo
