#include "stages/erode/erode_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

// Random bytes erode to nearly nothing; mostly full ones keep something to disagree about.
TEST(ErodeVk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(5);
    const auto stage = test::must(vk::Erode::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : test::awkward_sizes())
      for (const Neighbours neighbours : {Neighbours::kFour, Neighbours::kEight}) {
        Image<std::uint8_t> src(size), want(size);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            src.at(y, x) = static_cast<std::uint8_t>(0xFF & ~(rng() % 4 ? 0u : 1u << rng() % 8));
        ref::erode(src, neighbours, want.view());
        const test::OnDevice<std::uint8_t> in(device, src, "src"), out(device, size, "dst");
        recorder.begin();
        in.record_upload(recorder);
        out.record_upload(recorder);
        stage.record(recorder, in.view(), neighbours, out.view(), size);
        out.record_download(recorder);
        test::must(recorder.end());
        test::must(recorder.run());
        test::expect_same<std::uint8_t>(want, out.pixels("erode" + where), "erode" + where);
        if (HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
