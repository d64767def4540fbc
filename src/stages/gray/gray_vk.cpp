#include "stages/gray/gray_vk.h"

#include "stages/gray/gray_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kGrayCode[] = {
#include "spirv/gray.comp.inc"
};

}  // namespace

Result<Gray> Gray::make(const Device& device) {
  Gray out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"gray", kGrayCode, 2, sizeof(GrayPush)}));
  return out;
}

void Gray::record(Recorder& recorder, BufferView<Rgb8> src, BufferView<std::uint8_t> dst, Size size) const {
  DUO_CHECK(src.holds(size) && dst.holds(size));
  const GrayPush push{src.plane, dst.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(src), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
