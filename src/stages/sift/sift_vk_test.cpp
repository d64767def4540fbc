#include "stages/sift/sift_vk.h"

#include <cmath>

#include "tests/records_vk.h"

namespace duo {
namespace {

/// Random blobs of many sizes, for points in every octave, and noise of a few gray levels.
Image<std::uint8_t> blobs(Size size, unsigned noise, std::mt19937& rng) {
  const auto uniform = [&](double low, double high) { return low + (high - low) * (rng() % 10007) / 10007.0; };
  Image<float> sum(size);
  for (int i = 0; i < size.width * size.height / 40; ++i) {
    const double x = uniform(0, size.width), y = uniform(0, size.height), sigma = std::pow(2, uniform(0, 2.2)),
                 height = uniform(-60, 60);
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u)
        sum.at(v, u) += static_cast<float>(height * std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * sigma * sigma)));
  }
  Image<std::uint8_t> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out.at(y, x) = static_cast<std::uint8_t>(std::lround(std::clamp(110.0 + sum.at(y, x) + rng() % (noise + 1), 0.0, 255.0)));
  return out;
}

double descriptor_distance(const SiftPoints& a, int i, const SiftPoints& b, int k) {
  double square = 0;
  for (int d = 0; d < SiftPoints::kDescriptor; ++d) square += std::pow(a.descriptors.at(i, d) - b.descriptors.at(k, d), 2);
  return std::sqrt(square) / 512;  // the length of a descriptor
}

/// How many points two lists share.
struct Shared {
  int points = 0, near = 0, same = 0;
  void count(const SiftPoints& want, const SiftPoints& got) {
    points += std::max(want.count, got.count);
    for (int i = 0; i < want.count; ++i)
      for (int k = 0; k < got.count; ++k) {
        const SiftPoint &a = want[i], &b = got[k];
        if (std::hypot(a.x_px - b.x_px, a.y_px - b.y_px) > 0.5 ||
            std::abs(std::remainder(a.angle_rad - b.angle_rad, 6.2831853)) > 0.05 ||
            descriptor_distance(want, i, got, k) > 0.05)
          continue;
        ++near;
        same += a == b && descriptor_distance(want, i, got, k) == 0;
        break;
      }
  }
};

// Four windows at once, then four others: inside, over the border, empty, a strip. Points come in the
// order of the reference, so that most have its index too.
TEST(SiftVk, FindsWhatTheReferenceFinds) {
  constexpr Size kSize{150, 121};
  constexpr SiftListShape kLists{4, 200};
  const Window rounds[2][4] = {{{30, 10, 96, 96}, {0, 0, 40, 90}, {-20, 60, 60, 96}, {10, 10, 0, 0}},
                               {{54, 25, 96, 96}, {149, 120, 1, 1}, {3, 5, 17, 96}, {20, 90, 96, 31}}};
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(6);
    const auto stage = test::must(vk::Sift::make(device));
    const auto scratch = test::must(vk::Sift::Scratch::make(device, {96, 96}, kLists.lists, kLists.capacity));
    auto recorder = test::must(vk::Recorder::make(device));
    const test::Records<Window> windows(device, 4, "windows");
    const test::Records<std::byte> points(device, sift_list_bytes(kLists), "points");

    Shared shared;
    for (const unsigned noise : {0u, 40u}) {
      const Image<std::uint8_t> picture = blobs(kSize, noise, rng);
      const test::OnDevice<std::uint8_t> src(device, picture, "src");
      recorder.begin();
      src.record_upload(recorder);
      windows.record_upload(recorder);
      stage.record(recorder, src.view(), windows.buffer(), scratch, points.buffer(), kSize);
      points.record_download(recorder);
      test::must(recorder.end());
      for (const auto& round : rounds) {
        std::memcpy(windows.bytes().data(), round, sizeof round);
        test::must(recorder.run());
        for (int list = 0; list < 4; ++list) {
          SiftPoints want(kLists.capacity), got(kLists.capacity);
          ref::sift(picture, round[list], {}, want);
          read_sift_list(points.bytes(), kLists, list, got);
          EXPECT_EQ(got.overflow, want.overflow) << where << " list " << list;
          shared.count(want, got);
        }
      }
    }
    std::printf("sift%s: of %d points %d near, %d the same\n", where.c_str(), shared.points, shared.near, shared.same);
    EXPECT_GT(shared.points, 200);
    EXPECT_GE(shared.near * 100, shared.points * 95);
  });
}

TEST(SiftVk, CountsWhatFindsNoRoom) {
  if (test::assisted()) GTEST_SKIP() << "the same kernels as above";
  constexpr Size kSize{100, 96};
  constexpr SiftListShape kLists{1, 5};
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(3);
    const auto stage = test::must(vk::Sift::make(device));
    SiftParams params;
    params.octaves = 2;
    const auto scratch = test::must(vk::Sift::Scratch::make(device, kSize, 1, kLists.capacity, params));
    auto recorder = test::must(vk::Recorder::make(device));
    const Window all = Window::all(kSize);
    const test::Records<Window> windows(device, std::span(&all, 1), "windows");
    const test::Records<std::byte> points(device, sift_list_bytes(kLists), "points");
    const Image<std::uint8_t> picture = blobs(kSize, 0, rng);
    const test::OnDevice<std::uint8_t> src(device, picture, "src");
    recorder.begin();
    src.record_upload(recorder);
    windows.record_upload(recorder);
    stage.record(recorder, src.view(), windows.buffer(), scratch, points.buffer(), kSize);
    points.record_download(recorder);
    test::must(recorder.end());
    test::must(recorder.run());
    SiftPoints want(kLists.capacity), got(kLists.capacity);
    ref::sift(picture, all, params, want);
    read_sift_list(points.bytes(), kLists, 0, got);
    EXPECT_EQ(got.count, kLists.capacity) << where;
    EXPECT_GT(got.overflow, 0) << where;
    Shared shared;
    shared.count(want, got);
    EXPECT_EQ(shared.near, kLists.capacity) << where;
  });
}

}  // namespace
}  // namespace duo
