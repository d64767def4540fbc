#include "stages/sums/sums_vk.h"

#include <cstddef>

#include "stages/sums/sums_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kSumsCode[] = {
#include "spirv/sums.comp.inc"
};
// The kernel writes results as they are.
static_assert(sizeof(AreaSums) == 96 && offsetof(AreaSums, hue_sin_q14) == 72 && offsetof(AreaSums, first) == 80 &&
              offsetof(AreaSums, last) == 88 && offsetof(Pixel, x) == 4);

}  // namespace

Result<Sums::Scratch> Sums::Scratch::make(const Device& device, int areas) {
  Scratch out;
  const auto bytes = static_cast<std::size_t>(areas) * kAreaGroups * sizeof(AreaSums);
  DUO_TRY_ASSIGN(out.partial_, Buffer::make(device, "partial sums", bytes, Memory::kDevice));
  return out;
}

Result<Sums> Sums::make(const Device& device) {
  Sums out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"sums", kSumsCode, 6, sizeof(SumsPush)}));
  return out;
}

void Sums::record(Recorder& recorder, const Input& in, const Scratch& scratch, const Buffer& results, Size size) const {
  const auto count = static_cast<std::size_t>(in.count);
  DUO_CHECK(in.areas != nullptr && in.count > 0 && in.areas->bytes() >= count * sizeof(DeviceArea));
  DUO_CHECK(scratch.partial_.bytes() >= count * kAreaGroups * sizeof(AreaSums) && results.bytes() >= count * sizeof(AreaSums));
  DUO_CHECK((in.marks.absent() || in.marks.holds(size)) && (in.hue.absent() || in.hue.holds(size)) &&
            (in.d_q4.absent() || in.d_q4.holds(size)));
  SumsPush push{in.marks.plane,     in.hue.plane,     in.d_q4.plane,     size.width, size.height,
                !in.marks.absent(), !in.hue.absent(), !in.d_q4.absent(), 1};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(*in.areas) : reads(view); };
  const auto dispatch = [&](Size groups) {
    recorder.dispatch(
        kernel_, push,
        {reads(*in.areas), present(in.marks), present(in.hue), present(in.d_q4), writes(scratch.partial_), writes(results)},
        groups);
  };
  dispatch({kAreaGroups, in.count});
  push.partial = 0;
  dispatch({1, in.count});
}

}  // namespace duo::vk
