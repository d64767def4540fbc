#include "stages/halve/halve_vk.h"

#include "stages/halve/halve_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kHalveCode[] = {
#include "spirv/halve.comp.inc"
};

}  // namespace

Result<Halve> Halve::make(const Device& device) {
  Halve out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"halve", kHalveCode, 2, sizeof(HalvePush)}));
  return out;
}

void Halve::record(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const {
  record_with(recorder, src, dst, size, false);
}

void Halve::record_inside(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const {
  record_with(recorder, src, dst, size, true);
}

void Halve::record_with(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size,
                        bool all) const {
  DUO_CHECK(src.holds(size) && dst.holds(half_of(size)));
  const HalvePush push{src.plane, dst.plane, size.width, size.height, all};
  recorder.dispatch(kernel_, push, {reads(src), writes(dst)}, groups_for(half_of(size)));
}

}  // namespace duo::vk
