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
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"weighted median", kWeightedMedianCode, 4, sizeof(WeightedMedianPush)}));
  return out;
}

void WeightedMedian::record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> dst, Size size) const {
  const bool only_filled = !in.origin.absent();
  DUO_CHECK(in.d_q4.holds(size) && in.guide.holds(size) && dst.holds(size) && (!only_filled || in.origin.holds(size)));
  const WeightedMedianPush push{in.d_q4.plane, in.guide.plane, in.origin.plane, dst.plane,
                                size.width,    size.height,    only_filled};
  // Every binding needs a buffer; the kernel does not look at the one that stands in for an absent origin.
  recorder.dispatch(kernel_, push,
                    {reads(in.d_q4), reads(in.guide), only_filled ? reads(in.origin) : reads(in.guide), writes(dst)},
                    groups_for(size));
}

}  // namespace duo::vk
