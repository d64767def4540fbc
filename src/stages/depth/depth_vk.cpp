#include "stages/depth/depth_vk.h"

#include <numeric>
#include <vector>

#include "stages/depth/depth_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kDepthCode[] = {
#include "spirv/depth.comp.inc"
};

}  // namespace

Result<Depth> Depth::make(Device& device, float focal_baseline_px_mm) {
  constexpr Size kTable{1 << 16, 1};
  Depth out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"depth", kDepthCode, 3, sizeof(DepthPush)}));
  std::vector<std::uint16_t> every(kTable.width), answers(kTable.width);
  std::iota(every.begin(), every.end(), std::uint16_t{0});
  ref::depth(View<const std::uint16_t>(every.data(), kTable, kTable.width), focal_baseline_px_mm,
             View<std::uint16_t>(answers.data(), kTable, kTable.width));
  DUO_TRY_ASSIGN(out.table_, make_filled(device, "depth table", std::as_bytes(std::span(answers))));
  return out;
}

void Depth::record(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint16_t> depth_mm, Size size) const {
  DUO_CHECK(d_q4.holds(size) && depth_mm.holds(size));
  const DepthPush push{d_q4.plane, depth_mm.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(d_q4), reads(table_), writes(depth_mm)}, groups_for(size));
}

}  // namespace duo::vk
