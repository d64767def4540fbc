#include "stages/region/region_vk.h"

#include "tests/records_vk.h"

namespace duo {
namespace {

constexpr int kRegions = 6;

/// One region a bit, windows inside, across and outside the border.
std::vector<duo::Region> random_regions(std::mt19937& rng, Size size) {
  const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  std::vector<duo::Region> out(1 + rng() % kRegions);
  const int first_bit = below(8);
  for (std::size_t i = 0; i < out.size(); ++i) {
    duo::Region& in = out[i];
    in.bit = (first_bit + static_cast<int>(i)) % 8;
    in.seed = {below(size.height + 6) - 3, below(size.width + 6) - 3};
    in.window = below(2) == 0 ? Window::all(size)
                              : Window{below(size.width + 4) - 4, below(size.height + 4) - 4, below(size.width + 8),
                                       below(size.height + 8)};
  }
  return out;
}

/// Noise of any density, a comb of long teeth, and a spiral: the longest way from a region's last pixel to its first.
Image<std::uint8_t> marks_of(Size size, int round, std::mt19937& rng) {
  Image<std::uint8_t> out(size);
  const unsigned share = 1 + rng() % 9;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int ring = std::min(std::min(x, y), std::min(size.width - 1 - x, size.height - 1 - y));
      const bool spiral = (ring % 2 == 0) != (y == ring + 1 && x == ring);
      const bool comb = x % 2 == 0 || y == size.height - 1;
      const bool noise = rng() % 10 < share;
      const bool full = round % 4 == 1 ? spiral : round % 4 == 2 ? comb : noise;
      out.at(y, x) = static_cast<std::uint8_t>(full ? 0xFF : round % 4 == 0 ? rng() : 0);
    }
  return out;
}

TEST(RegionVk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(11);
    const auto stage = test::must(vk::Region::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{131, 37}, Size{70, 150}}) {
      const auto scratch = test::must(vk::Region::Scratch::make(device, size, kRegions));
      for (int round = 0; round < (test::assisted() ? 1 : 8); ++round) {
        Image<std::uint8_t> want = marks_of(size, round, rng);
        const test::OnDevice<std::uint8_t> marks_vk(device, want, "marks");
        const test::Records<std::byte> tasks_vk(device, vk::Region::task_bytes(kRegions), "tasks");
        const test::Records<RegionLabel> labels_vk(device, kRegions, "labels");
        const auto regions = random_regions(rng, size);
        vk::Region::write(regions, tasks_vk.bytes());
        recorder.begin();
        marks_vk.record_upload(recorder);
        tasks_vk.record_upload(recorder);
        stage.record(recorder, tasks_vk.buffer(), kRegions, marks_vk.view(), scratch, labels_vk.buffer(), size);
        marks_vk.record_download(recorder);
        labels_vk.record_download(recorder);
        test::must(recorder.end());
        test::must(recorder.run());

        const auto labels = labels_vk.read();
        for (std::size_t i = 0; i < kRegions; ++i) {
          RegionLabel one;
          if (i < regions.size()) one = ref::keep_region(regions[i], want.view());
          EXPECT_EQ(labels[i], one) << "region" << where << " " << size.width << "x" << size.height << " round " << round
                                    << " region " << i << ": label " << labels[i].label << " want " << one.label;
        }
        test::expect_same<std::uint8_t>(want, marks_vk.pixels("region" + where), "region" + where);
        if (HasFailure()) return;
      }
    }
  });
}

}  // namespace
}  // namespace duo
