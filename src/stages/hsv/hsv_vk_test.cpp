#include "stages/hsv/hsv_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

// Every fill has all three channels alike or random; the colours beside them are those where hue changes its formula.
Image<Rgb8> colors(Size size, test::Fill how, std::mt19937& rng) {
  Image<std::uint8_t> channels({3 * size.width, size.height});
  test::fill(channels.view(), how, rng);
  Image<Rgb8> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::uint8_t* c = channels.row(y) + 3 * x;
      out.at(y, x) = {c[0], c[1], rng() % 3 == 0 ? c[rng() % 2] : c[2]};
    }
  return out;
}

TEST(HsvVk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto stage = test::must(vk::Hsv::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{3, 2}, Size{131, 137}})
      for (const test::Fill how : test::kFills) {
        const Image<Rgb8> src = colors(size, how, rng);
        Image<std::uint8_t> hue(size), saturation(size), value(size);
        ref::hsv(src, {hue.view(), saturation.view(), value.view()});
        const test::OnDevice<Rgb8> in(device, src, "src");
        const test::OnDevice<std::uint8_t> hue_vk(device, size, "hue"), saturation_vk(device, size, "saturation"),
            value_vk(device, size, "value");
        recorder.begin();
        in.record_upload(recorder);
        for (const auto* plane : {&hue_vk, &saturation_vk, &value_vk}) plane->record_upload(recorder);
        stage.record(recorder, in.view(), {hue_vk.view(), saturation_vk.view(), value_vk.view()}, size);
        for (const auto* plane : {&hue_vk, &saturation_vk, &value_vk}) plane->record_download(recorder);
        test::must(recorder.end());
        test::must(recorder.run());
        test::expect_same<std::uint8_t>(hue, hue_vk.pixels("hue" + where), "hue" + where);
        test::expect_same<std::uint8_t>(saturation, saturation_vk.pixels("saturation" + where), "saturation" + where);
        test::expect_same<std::uint8_t>(value, value_vk.pixels("value" + where), "value" + where);
        if (HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
