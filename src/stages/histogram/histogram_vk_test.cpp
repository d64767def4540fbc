#include "stages/histogram/histogram_vk.h"

#include "tests/areas_vk.h"

namespace duo {
namespace {

TEST(HistogramVk, Agrees) {
  constexpr int kAreas = 3;
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(17);
    const auto stage = test::must(vk::Histogram::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{150, 97}})
      for (const bool whole : {false, true}) {
        Image<std::uint8_t> hue(size), saturation(size), value(size), marks(size);
        for (auto* plane : {&hue, &saturation, &value}) test::fill(plane->view(), test::kFills[rng() % 5], rng);
        test::fill_marks(marks.view(), rng);
        const test::OnDevice<std::uint8_t> hue_vk(device, hue, "hue"), saturation_vk(device, saturation, "saturation"),
            value_vk(device, value, "value"), marks_vk(device, marks, "marks");
        const test::Records<vk::DeviceArea> areas_vk(device, kAreas, "areas");
        const test::Records<ColorHistogram> bins_vk(device, kAreas, "histograms");
        vk::Histogram::Input in{&areas_vk.buffer(), kAreas, hue_vk.view(), saturation_vk.view(), value_vk.view()};
        if (!whole) in.marks = marks_vk.view();
        in.min_value = static_cast<std::uint8_t>(rng() % 200);
        recorder.begin();
        for (const auto* plane : {&hue_vk, &saturation_vk, &value_vk, &marks_vk}) plane->record_upload(recorder);
        areas_vk.record_upload(recorder);
        stage.record(recorder, in, bins_vk.buffer(), size);
        bins_vk.record_download(recorder);
        test::must(recorder.end());

        for (int round = 0; round < 3; ++round) {
          const auto areas = test::put_random_areas(rng, size, marks, !whole, areas_vk);
          test::must(recorder.run());
          const auto got = bins_vk.read();
          for (std::size_t i = 0; i < kAreas; ++i)
            EXPECT_EQ(got[i], ref::color_histogram({hue, saturation, value, areas[i], in.min_value}))
                << "histogram" << where << " " << size.width << "x" << size.height << " area " << i;
          if (HasFailure()) return;
        }
      }
  });
}

}  // namespace
}  // namespace duo
