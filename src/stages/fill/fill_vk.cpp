#include "stages/fill/fill_vk.h"

#include "stages/fill/fill_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kFillCode[] = {
#include "spirv/fill.comp.inc"
};

}  // namespace

Result<Fill> Fill::make(const Device& device) {
  Fill out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"fill", kFillCode, 2, sizeof(FillPush)}));
  return out;
}

void Fill::record_measured(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin,
                           Size size) const {
  record_with(recorder, d_q4, origin, size, false);
}

void Fill::record(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin, Size size) const {
  record_with(recorder, d_q4, origin, size, true);
}

void Fill::record_with(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin, Size size,
                       bool fills) const {
  DUO_CHECK(d_q4.holds(size) && origin.holds(size) && size.width <= kFillMaxWidth);
  const FillPush push{d_q4.plane, origin.plane, size.width, fills};
  recorder.dispatch(kernel_, push, {writes(d_q4), writes(origin)}, {size.height, 1});
}

}  // namespace duo::vk
