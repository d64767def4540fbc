#include "stages/median/median_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

const auto kMake = [](const vk::Device& device) { return vk::Median::make(device); };
const auto kRecord = [](const vk::Median& median, vk::Recorder& recorder, auto src, auto dst, Size size) {
  median.record(recorder, src, dst, size);
};

TEST(MedianVk, AgreesU8) {
  test::agree_vk<std::uint8_t, std::uint8_t>(
      "median u8", [](auto src, auto dst) { ref::median3x3(src, dst); }, kMake, kRecord);
}

TEST(MedianVk, AgreesU16) {
  test::agree_vk<std::uint16_t, std::uint16_t>(
      "median u16", [](auto src, auto dst) { ref::median3x3(src, dst); }, kMake, kRecord);
}

}  // namespace
}  // namespace duo
