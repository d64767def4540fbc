#include "stages/depth/depth_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(DepthVk, AgreesOnEveryDisparity) {
  test::each_device([](vk::Device& device, const std::string& where) {
    Image<std::uint16_t> d({259, 254}), want(d.size());
    static_assert(259 * 254 >= 65536);
    for (int i = 0; i < 259 * 254; ++i) d.at(i / 259, i % 259) = static_cast<std::uint16_t>(i);
    auto recorder = must(vk::Recorder::make(device));
    const OnDevice<std::uint16_t> in(device, d, "d_q4"), out(device, d.size(), "depth");
    for (const float focal_baseline : {60000.0F, 70236.7F, 123.4F, 1.0e7F}) {
      ref::depth(d, focal_baseline, want);
      const auto depth = must(vk::Depth::make(device, focal_baseline));
      test::run_with(
          recorder, [&] { depth.record(recorder, in.view(), out.view(), d.size()); }, in, out);
      test::expect_same<std::uint16_t>(want, out.pixels("depth" + where), "depth" + where);
    }
  });
}

TEST(DepthVk, AgreesAtEverySize) {
  test::agree_vk<std::uint16_t, std::uint16_t>(
      "depth", [](auto src, auto dst) { ref::depth(src, 70236.7F, dst); },
      [](vk::Device& device) { return vk::Depth::make(device, 70236.7F); },
      [](const vk::Depth& depth, vk::Recorder& recorder, auto src, auto dst, Size size) {
        depth.record(recorder, src, dst, size);
      });
}

}  // namespace
}  // namespace duo
