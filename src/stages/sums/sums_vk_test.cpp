#include "stages/sums/sums_vk.h"

#include "tests/areas_vk.h"
#include "tests/targets.h"

namespace duo {
namespace {

TEST(SumsVk, Agrees) {
  constexpr int kAreas = 6;
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(12);
    const auto stage = test::must(vk::Sums::make(device));
    const auto scratch = test::must(vk::Sums::Scratch::make(device, kAreas));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{131, 37}, Size{150, 97}})
      for (const bool whole : {false, true}) {
        Image<std::uint8_t> marks(size), hue(size);
        Image<std::uint16_t> d(size);
        test::fill_marks(marks.view(), rng);
        test::fill(hue.view(), test::Fill::kRandom, rng);
        test::fill_disparity(d.view(), rng);
        const test::OnDevice<std::uint8_t> marks_vk(device, marks, "marks"), hue_vk(device, hue, "hue");
        const test::OnDevice<std::uint16_t> d_vk(device, d, "disparity");
        const test::Records<vk::DeviceArea> areas_vk(device, kAreas, "areas");
        const test::Records<AreaSums> sums_vk(device, kAreas, "sums");
        vk::Sums::Input in{&areas_vk.buffer(), kAreas};
        if (!whole) in.marks = marks_vk.view();
        in.hue = hue_vk.view();
        if (!whole) in.d_q4 = d_vk.view();
        recorder.begin();
        for (const auto* plane : {&marks_vk, &hue_vk}) plane->record_upload(recorder);
        d_vk.record_upload(recorder);
        areas_vk.record_upload(recorder);
        stage.record(recorder, in, scratch, sums_vk.buffer(), size);
        sums_vk.record_download(recorder);
        test::must(recorder.end());

        for (int round = 0; round < 4; ++round) {
          const auto areas = test::put_random_areas(rng, size, marks, !whole, areas_vk);
          test::must(recorder.run());
          const auto got = sums_vk.read();
          for (std::size_t i = 0; i < kAreas; ++i) {
            duo::Sums one{size, areas[i], hue, d};
            if (whole) one.d_q4 = {};
            EXPECT_EQ(got[i], ref::sums(one)) << "sums" << where << " " << size.width << "x" << size.height << " area " << i;
          }
          if (HasFailure()) return;
        }
      }
  });
}

// Sums beyond 32 bits, without any picture.
TEST(SumsVk, HoldsLargePictures) {
  constexpr Size kSize{1201, 900};
  const Area area{Window::all(kSize), {700, 400, 850}};
  const AreaSums want = ref::sums({kSize, area});
  ASSERT_GT(want.xx, std::int64_t{1} << 37);
  test::each_device([&](vk::Device& device, const std::string& where) {
    const auto stage = test::must(vk::Sums::make(device));
    const auto scratch = test::must(vk::Sums::Scratch::make(device, 1));
    auto recorder = test::must(vk::Recorder::make(device));
    const vk::DeviceArea words = vk::device_area(area);
    const test::Records<vk::DeviceArea> areas(device, std::span(&words, 1), "areas");
    const test::Records<AreaSums> sums(device, 1, "sums");
    recorder.begin();
    areas.record_upload(recorder);
    stage.record(recorder, {&areas.buffer(), 1}, scratch, sums.buffer(), kSize);
    sums.record_download(recorder);
    test::must(recorder.end());
    test::must(recorder.run());
    EXPECT_EQ(sums.read()[0], want) << where;
  });
}

}  // namespace
}  // namespace duo
