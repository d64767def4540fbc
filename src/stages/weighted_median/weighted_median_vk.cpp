#include "stages/weighted_median/weighted_median_vk.h"

#include "stages/weighted_median/weighted_median_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kWeightedMedianCode[] = {
#include "spirv/weighted_median.comp.inc"
};

}  // namespace

Result<WeightedMedian> WeightedMedian::make(const Device& device) {
  WeightedMedian out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"weighted median", kWeightedMedianCode, 3, sizeof(WeightedMedianPush)}));
  return out;
}

void WeightedMedian::record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> dst, Size size) const {
  DUO_CHECK(in.d_q4.holds(size) && in.guide.holds(size) && dst.holds(size));
  const WeightedMedianPush push{in.d_q4.plane, in.guide.plane, dst.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(in.d_q4), reads(in.guide), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
