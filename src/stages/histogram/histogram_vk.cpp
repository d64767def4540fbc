#include "stages/histogram/histogram_vk.h"

#include "stages/histogram/histogram_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kHistogramCode[] = {
#include "spirv/histogram.comp.inc"
};
static_assert(kHistogramBins == kColorBins);

}  // namespace

Result<Histogram> Histogram::make(const Device& device) {
  Histogram out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"histogram", kHistogramCode, 6, sizeof(HistogramPush)}));
  return out;
}

void Histogram::record(Recorder& recorder, const Input& in, const Buffer& results, Size size) const {
  const auto count = static_cast<std::size_t>(in.count);
  DUO_CHECK(in.areas != nullptr && in.count > 0 && in.areas->bytes() >= count * sizeof(DeviceArea));
  DUO_CHECK(in.hue.holds(size) && in.saturation.holds(size) && in.value.holds(size));
  DUO_CHECK((in.marks.absent() || in.marks.holds(size)) && results.bytes() >= count * sizeof(ColorHistogram));
  const HistogramPush push{in.hue.plane, in.saturation.plane, in.value.plane,     in.marks.plane,
                           size.width,   size.height,         !in.marks.absent(), in.min_value};
  recorder.fill(results, 0);
  recorder.dispatch(kernel_, push,
                    {reads(*in.areas), reads(in.hue), reads(in.saturation), reads(in.value),
                     in.marks.absent() ? reads(in.hue) : reads(in.marks), writes(results)},
                    {kAreaGroups, in.count});
}

}  // namespace duo::vk
