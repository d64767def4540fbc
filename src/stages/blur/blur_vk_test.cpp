#include "stages/blur/blur_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(BlurVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(7);
    const auto stage = must(vk::Blur::make(device));
    const auto scratch = must(vk::Blur::make_scratch(device));
    auto recorder = must(vk::Recorder::make(device));
    const auto blur = must(vk::Buffer::make(device, "blur", sizeof(std::uint32_t), vk::Memory::kDevice));
    const auto found = must(vk::Buffer::make(device, "blur found", sizeof(std::uint32_t), vk::Memory::kDownload));
    int known = 0;
    for (const Size size : {Size{1, 1}, Size{13, 40}, Size{14, 14}, Size{131, 75}})
      for (const int spread : {0, 3, 9, 60, 235})
        for (const int run : {1, 3}) {  // pixels of one value side by side
          Image<std::uint8_t> left(size), right(size);
          for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
              left.at(y, x) =
                  x % run != 0 ? left.at(y, x - 1) : static_cast<std::uint8_t>(20 + rng() % static_cast<unsigned>(spread + 1));
              right.at(y, x) = static_cast<std::uint8_t>(100 + rng() % 9);
            }
          const OnDevice<std::uint8_t> l(device, left, "left"), r(device, right, "right");
          test::run_with(
              recorder,
              [&] {
                stage.record(recorder, l.view(), r.view(), scratch, blur, size);
                recorder.copy(blur, found, sizeof(std::uint32_t));
              },
              l, r);
          std::uint32_t got = 0;
          std::memcpy(&got, found.mapped().data(), sizeof(got));
          const int want = ref::blur_q4(left, right);
          EXPECT_EQ(static_cast<int>(got), want) << size.width << "x" << size.height << where;
          known += want != kBlurUnknown;
        }
    EXPECT_GT(known, 5);
  });
}

}  // namespace
}  // namespace duo
