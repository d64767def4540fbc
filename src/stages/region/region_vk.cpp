#include "stages/region/region_vk.h"

#include <cstring>

#include "stages/region/region_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kRegionCode[] = {
#include "spirv/region.comp.inc"
};
static_assert(sizeof(RegionLabel) == 8);  // the kernel writes results as they are

constexpr int kMostPixels = 65535 * kRegionLanes;  // in one dispatch

std::size_t forest_bytes(int room, int regions) {
  return (2 * static_cast<std::size_t>(room) + 2 * kRegionGroups) * static_cast<std::size_t>(regions) * sizeof(std::int32_t);
}

}  // namespace

Result<Region::Scratch> Region::Scratch::make(const Device& device, Size largest_window, int regions) {
  DUO_CHECK(regions > 0 && regions <= kMostRegions);
  Scratch out;
  out.room_ = largest_window.width * largest_window.height;
  out.regions_ = regions;
  DUO_CHECK(out.room_ <= kMostPixels);
  DUO_TRY_ASSIGN(out.forest_, Buffer::make(device, "regions", forest_bytes(out.room_, regions), Memory::kDevice));
  return out;
}

Result<Region> Region::make(const Device& device) {
  Region out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"region", kRegionCode, 4, sizeof(RegionPush)}));
  return out;
}

void Region::record(Recorder& recorder, const Buffer& tasks, int count, BufferView<std::uint8_t> marks, const Scratch& scratch,
                    const Buffer& results, Size size) const {
  DUO_CHECK(count > 0 && count <= scratch.regions_ && tasks.bytes() >= task_bytes(count));
  DUO_CHECK(marks.holds(size) && size.width * size.height <= kMostPixels);
  DUO_CHECK(results.bytes() >= static_cast<std::size_t>(count) * sizeof(RegionLabel));
  const auto groups = [](int pixels) { return (pixels + kRegionLanes - 1) / kRegionLanes; };
  const auto dispatch = [&](int step, Size in) {
    const RegionPush push{marks.plane, size.width, size.height, count, scratch.room_, step};
    const Use use_marks = step == kRegionClear ? writes(marks) : reads(marks);
    recorder.dispatch(kernel_, push, {reads(tasks), use_marks, writes(scratch.forest_), writes(results)}, in);
  };
  for (const int step : {kRegionRuns, kRegionJoin, kRegionCount}) dispatch(step, {groups(scratch.room_), count});
  dispatch(kRegionChoose, {kRegionGroups, count});
  dispatch(kRegionClear, {groups(size.width * size.height), 1});
}

std::size_t Region::task_bytes(int count) { return static_cast<std::size_t>(count) * sizeof(RegionTask); }

void Region::write(std::span<const duo::Region> regions, std::span<std::byte> tasks) {
  DUO_CHECK(tasks.size() >= regions.size() * sizeof(RegionTask));
  std::memset(tasks.data(), 0, tasks.size());
  unsigned bits = 0;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const duo::Region& in = regions[i];
    DUO_CHECK(in.bit >= 0 && in.bit < 8 && (bits >> in.bit & 1) == 0);
    bits |= 1u << in.bit;
    const Window& window = in.window;
    const RegionTask task{in.bit, window.x, window.y, window.x_end(), window.y_end(), in.seed.y, in.seed.x};
    std::memcpy(tasks.data() + i * sizeof task, &task, sizeof task);
  }
}

}  // namespace duo::vk
