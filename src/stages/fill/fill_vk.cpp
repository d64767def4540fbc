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
  DUO_CHECK(d_q4.holds(size) && origin.holds(size));
  recorder.dispatch(kernel_, FillPush{d_q4.plane, origin.plane, size.width, size.height}, {reads(d_q4), writes(origin)},
                    groups_for(size));
}

}  // namespace duo::vk
