#include "stages/sample_depth/sample_depth_vk.h"

#include "tests/areas_vk.h"

namespace duo {
namespace {

TEST(SampleDepthVk, Agrees) {
  constexpr int kAreas = 4;
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(15);
    const auto stage = test::must(vk::SampleDepth::make(device));
    const auto scratch = test::must(vk::SampleDepth::Scratch::make(device, kAreas));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{150, 97}})
      for (const unsigned range : {3u, 300u, 70000u}) {
        Image<std::uint8_t> marks(size);
        Image<std::uint16_t> d(size);
        test::fill_marks(marks.view(), rng);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            d.at(y, x) = static_cast<std::uint16_t>(rng() % 7 == 0 ? Disparity::kNone : 250 + rng() % range);
        const test::OnDevice<std::uint8_t> marks_vk(device, marks, "marks");
        const test::OnDevice<std::uint16_t> d_vk(device, d, "disparity");
        const test::Records<vk::DeviceArea> areas_vk(device, kAreas, "areas");
        const test::Records<DepthSample> samples_vk(device, kAreas, "samples");
        const bool whole = range == 300;
        vk::SampleDepth::Input in{&areas_vk.buffer(), kAreas, d_vk.view()};
        if (!whole) in.marks = marks_vk.view();
        recorder.begin();
        marks_vk.record_upload(recorder);
        d_vk.record_upload(recorder);
        areas_vk.record_upload(recorder);
        stage.record(recorder, in, scratch, samples_vk.buffer(), size);
        samples_vk.record_download(recorder);
        test::must(recorder.end());

        for (int round = 0; round < 3; ++round) {
          const auto areas = test::put_random_areas(rng, size, marks, !whole, areas_vk);
          test::must(recorder.run());
          const auto got = samples_vk.read();
          for (std::size_t i = 0; i < kAreas; ++i)
            EXPECT_EQ(got[i], ref::sample_depth(d, areas[i]))
                << "sample_depth" << where << " " << size.width << "x" << size.height << " range " << range << " area " << i;
          if (HasFailure()) return;
        }
      }
  });
}

}  // namespace
}  // namespace duo
