// The observation stages on a device one after the other, in one recording, as a tracker of coloured joints and stored points
// uses them: what changes from frame to frame goes up as targets, areas and windows, and a few kB come back.

#include <memory>

#include "stages/erode/erode_vk.h"
#include "stages/hsv/hsv_vk.h"
#include "stages/mark_targets/mark_targets_vk.h"
#include "stages/match_points/match_points_vk.h"
#include "stages/region/region_vk.h"
#include "stages/sample_depth/sample_depth_vk.h"
#include "stages/sift/sift_vk.h"
#include "stages/sums/sums_vk.h"
#include "tests/records_vk.h"

namespace duo {
namespace {

constexpr Size kSize{161, 120};
constexpr int kSide = 44;  // of windows, px
constexpr SiftListShape kLists{kMaxTargets, 48};

/// Six textured discs, each of a hue and a disparity of its own, before a gray wall.
struct Scene {
  Image<Rgb8> color{kSize};
  Image<std::uint8_t> gray{kSize};
  Image<std::uint16_t> d_q4{kSize};
  Pixel at[kMaxTargets];

  explicit Scene(int moved_px) {
    std::mt19937 rng(20);
    unsigned texture[kMaxTargets][7][7];
    for (auto& disc : texture)
      for (auto& row : disc)
        for (unsigned& patch : row) patch = rng() % 120;
    for (int t = 0; t < kMaxTargets; ++t) at[t] = {30 + 60 * (t / 3), 26 + 50 * (t % 3) + moved_px};
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        color.at(y, x) = {90, 90, 90};
        d_q4.at(y, x) = rng() % 6 == 0 ? Disparity::kNone : 160;
        for (int t = 0; t < kMaxTargets; ++t) {
          if (!Disc{at[t].x, at[t].y, 16}.contains(y, x)) continue;
          const int u = x - at[t].x, v = y - at[t].y;
          const auto light = static_cast<std::uint8_t>(120 + texture[t][(v + 16) / 5][(u + 16) / 5]);
          const auto dark = static_cast<std::uint8_t>(light / 4);
          color.at(y, x) = {t % 3 == 0 ? light : dark, t % 3 == 1 || t == 3 ? light : dark,
                            t % 3 == 2 || t == 4 ? light : dark};
          d_q4.at(y, x) = static_cast<std::uint16_t>(400 + 20 * t + static_cast<int>(rng() % 5));
        }
        const auto [r, g, b] = color.at(y, x);
        gray.at(y, x) = static_cast<std::uint8_t>((r + g + b) / 3);
      }
  }
};

/// Seen through windows that stay where the first frame's discs are.
struct Expectation {
  std::vector<Target> targets;
  std::vector<duo::Region> regions;
  std::vector<Window> windows;
  std::vector<SiftPoints> stored;

  explicit Expectation(const Scene& scene) {
    for (int t = 0; t < kMaxTargets; ++t) {
      const Pixel p = scene.at[t];
      const Rgb8 color = scene.color.at(p.y, p.x);
      Image<std::uint8_t> hue({1, 1}), saturation({1, 1}), value({1, 1});
      ref::hsv(View<const Rgb8>(&color, {1, 1}, 1), {hue.view(), saturation.view(), value.view()});
      Target target;
      target.color = {hue.at(0, 0), 8, 40, 40};
      target.gate = {300, 600, -1, false};
      target.window = {p.x - kSide / 2, p.y - kSide / 2, kSide, kSide};
      targets.push_back(target);
      windows.push_back(target.window);
      regions.push_back({t, target.window, duo::Region::Pick::kNearest, p});
      stored.emplace_back(kLists.capacity);
      ref::sift(scene.gray, target.window, {}, stored.back());
    }
  }
  std::vector<vk::DeviceArea> areas() const {
    std::vector<vk::DeviceArea> out;
    for (int t = 0; t < kMaxTargets; ++t)
      out.push_back(vk::device_area({windows[static_cast<std::size_t>(t)], {}, {}, static_cast<std::uint8_t>(1 << t)}));
    return out;
  }
};

struct Kernels {
  vk::Hsv hsv;
  vk::MarkTargets mark;
  vk::Erode erode;
  vk::Region region;
  vk::Sums sums;
  vk::SampleDepth depth;
  vk::Sift sift;
  vk::MatchPoints match;
  explicit Kernels(const vk::Device& device)
      : hsv(test::must(vk::Hsv::make(device))),
        mark(test::must(vk::MarkTargets::make(device))),
        erode(test::must(vk::Erode::make(device))),
        region(test::must(vk::Region::make(device))),
        sums(test::must(vk::Sums::make(device))),
        depth(test::must(vk::SampleDepth::make(device))),
        sift(test::must(vk::Sift::make(device))),
        match(test::must(vk::MatchPoints::make(device))) {}
};

void observe_ref(const Scene& scene, const Expectation& wanted, std::vector<RegionLabel>& labels, std::vector<AreaSums>& sums,
                 std::vector<DepthSample>& depths) {
  Image<std::uint8_t> hue(kSize), saturation(kSize), value(kSize), marks(kSize), eroded(kSize);
  ref::hsv(scene.color, {hue.view(), saturation.view(), value.view()});
  ref::mark_targets({hue, saturation, value, scene.d_q4, {}, wanted.targets}, marks.view());
  ref::erode(marks, Neighbours::kFour, eroded.view());
  for (const duo::Region& region : wanted.regions) labels.push_back(ref::keep_region(region, eroded.view()));
  for (int t = 0; t < kMaxTargets; ++t) {
    const Area area{wanted.windows[static_cast<std::size_t>(t)], {}, eroded, static_cast<std::uint8_t>(1 << t)};
    sums.push_back(ref::sums({kSize, area, hue, scene.d_q4}));
    depths.push_back(ref::sample_depth(scene.d_q4, area));
  }
}

TEST(ObserveVk, OneRecordingGivesTheReferencesObservation) {
  if (test::assisted()) GTEST_SKIP() << "each of its kernels is checked alone";
  const Expectation wanted(Scene(0));
  test::each_device([&](vk::Device& device, const std::string& where) {
    const Kernels kernels(device);
    const auto forest = test::must(vk::Region::Scratch::make(device, {kSide, kSide}, kMaxTargets));
    const auto partial = test::must(vk::Sums::Scratch::make(device, kMaxTargets));
    const auto counts = test::must(vk::SampleDepth::Scratch::make(device, kMaxTargets));
    const auto space = test::must(vk::Sift::Scratch::make(device, {kSide, kSide}, kMaxTargets, kLists.capacity));
    const test::OnDevice<std::uint8_t> hue(device, kSize, "hue"), saturation(device, kSize, "saturation"),
        value(device, kSize, "value"), marks(device, kSize, "marks"), eroded(device, kSize, "eroded");

    const auto areas = wanted.areas();
    const test::Records<std::byte> targets(device, vk::MarkTargets::wanted_bytes(1), "targets"),
        tasks(device, vk::Region::task_bytes(kMaxTargets), "tasks"), stored(device, sift_list_bytes(kLists), "stored");
    vk::MarkTargets::write(wanted.targets, {}, targets.bytes());
    vk::Region::write(wanted.regions, tasks.bytes());
    for (int t = 0; t < kMaxTargets; ++t)
      write_sift_list(wanted.stored[static_cast<std::size_t>(t)], kLists, t, stored.bytes());
    const test::Records<vk::DeviceArea> areas_vk(device, areas, "areas");
    const test::Records<Window> windows(device, wanted.windows, "windows");
    const test::Records<RegionLabel> labels(device, kMaxTargets, "labels");
    const test::Records<AreaSums> sums(device, kMaxTargets, "sums");
    const test::Records<DepthSample> depths(device, kMaxTargets, "depths");
    const test::Records<std::byte> seen(device, sift_list_bytes(kLists), "seen");
    const test::Records<PointMatch> matches(device, static_cast<std::size_t>(kMaxTargets * kLists.capacity), "matches");

    auto recorder = test::must(vk::Recorder::make(device));
    for (const int moved_px : {0, 3}) {
      const Scene scene(moved_px);
      const test::OnDevice<Rgb8> color(device, scene.color, "color");
      const test::OnDevice<std::uint8_t> gray(device, scene.gray, "gray");
      const test::OnDevice<std::uint16_t> d(device, scene.d_q4, "disparity");
      recorder.begin();
      color.record_upload(recorder);
      gray.record_upload(recorder);
      d.record_upload(recorder);
      for (const auto* list : {&targets, &tasks, &stored}) list->record_upload(recorder);
      areas_vk.record_upload(recorder);
      windows.record_upload(recorder);
      kernels.hsv.record(recorder, color.view(), {hue.view(), saturation.view(), value.view()}, kSize);
      kernels.mark.record(recorder, {hue.view(), saturation.view(), value.view(), d.view(), {}, &targets.buffer()},
                          marks.view(), kSize);
      kernels.erode.record(recorder, marks.view(), Neighbours::kFour, eroded.view(), kSize);
      kernels.region.record(recorder, tasks.buffer(), kMaxTargets, {}, eroded.view(), forest, labels.buffer(), kSize);
      kernels.sums.record(recorder, {&areas_vk.buffer(), kMaxTargets, eroded.view(), hue.view(), d.view()}, partial,
                          sums.buffer(), kSize);
      kernels.depth.record(recorder, {&areas_vk.buffer(), kMaxTargets, d.view(), eroded.view()}, counts, depths.buffer(),
                           kSize);
      kernels.sift.record(recorder, gray.view(), windows.buffer(), space, seen.buffer(), kSize);
      kernels.match.record(recorder, {&stored.buffer(), &seen.buffer(), nullptr, kLists, kLists}, {}, matches.buffer());
      labels.record_download(recorder);
      sums.record_download(recorder);
      depths.record_download(recorder);
      seen.record_download(recorder);
      matches.record_download(recorder);
      test::must(recorder.end());
      test::must(recorder.run());

      std::vector<RegionLabel> want_labels;
      std::vector<AreaSums> want_sums;
      std::vector<DepthSample> want_depths;
      observe_ref(scene, wanted, want_labels, want_sums, want_depths);
      EXPECT_EQ(labels.read(), want_labels) << where;
      EXPECT_EQ(sums.read(), want_sums) << where;
      EXPECT_EQ(depths.read(), want_depths) << where;
      const auto got_matches = matches.read();
      int found = 0;
      for (std::size_t t = 0; t < kMaxTargets; ++t) {
        EXPECT_GT(want_sums[t].count, 300) << "the scene shows target " << t;
        SiftPoints points(kLists.capacity);
        read_sift_list(seen.bytes(), kLists, static_cast<int>(t), points);
        std::vector<PointMatch> want(static_cast<std::size_t>(wanted.stored[t].count));
        ref::match_points(wanted.stored[t], {}, points, {}, want);
        for (std::size_t i = 0; i < want.size(); ++i) {
          EXPECT_EQ(got_matches[t * static_cast<std::size_t>(kLists.capacity) + i], want[i]) << where << " target " << t;
          found += want[i].seen != PointMatch::kNone;
        }
      }
      EXPECT_GT(found, 20) << where;
      if (HasFailure()) return;
    }
  });
}

}  // namespace
}  // namespace duo
