#include "stages/sample_depth/sample_depth_vk.h"

#include <cstddef>

#include "stages/sample_depth/sample_depth_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kSampleDepthCode[] = {
#include "spirv/sample_depth.comp.inc"
};
// The kernel writes results as they are.
static_assert(sizeof(DepthSample) == 16 && offsetof(DepthSample, lower_q4) == 8 && offsetof(DepthSample, upper_q4) == 12);

constexpr std::size_t kCountBytes = kDepthCounts * sizeof(std::uint32_t);

}  // namespace

Result<SampleDepth::Scratch> SampleDepth::Scratch::make(const Device& device, int areas) {
  Scratch out;
  DUO_TRY_ASSIGN(out.counts_,
                 Buffer::make(device, "depth counts", static_cast<std::size_t>(areas) * kCountBytes, Memory::kDevice));
  return out;
}

Result<SampleDepth> SampleDepth::make(const Device& device) {
  SampleDepth out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"sample depth", kSampleDepthCode, 5, sizeof(SampleDepthPush)}));
  return out;
}

void SampleDepth::record(Recorder& recorder, const Input& in, const Scratch& scratch, const Buffer& results, Size size) const {
  const auto count = static_cast<std::size_t>(in.count);
  DUO_CHECK(in.areas != nullptr && in.count > 0 && in.areas->bytes() >= count * sizeof(DeviceArea));
  DUO_CHECK(scratch.counts_.bytes() >= count * kCountBytes && results.bytes() >= count * sizeof(DepthSample));
  DUO_CHECK(in.d_q4.holds(size) && (in.marks.absent() || in.marks.holds(size)));
  recorder.fill(scratch.counts_, 0);
  for (const int step : {kCountHigh, kCountLow, kSelect}) {
    const SampleDepthPush push{in.d_q4.plane, in.marks.plane, size.width, size.height, !in.marks.absent(), step};
    recorder.dispatch(kernel_, push,
                      {reads(*in.areas), reads(in.d_q4), in.marks.absent() ? reads(*in.areas) : reads(in.marks),
                       writes(scratch.counts_), writes(results)},
                      {step == kSelect ? 1 : kAreaGroups, in.count});
  }
}

}  // namespace duo::vk
