#include "stages/erode/erode_vk.h"

#include "stages/erode/erode_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kErodeCode[] = {
#include "spirv/erode.comp.inc"
};

}  // namespace

Result<Erode> Erode::make(const Device& device) {
  Erode out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"erode", kErodeCode, 2, sizeof(ErodePush)}));
  return out;
}

void Erode::record(Recorder& recorder, BufferView<std::uint8_t> src, Neighbours neighbours, BufferView<std::uint8_t> dst,
                   Size size) const {
  DUO_CHECK(src.holds(size) && dst.holds(size));
  const ErodePush push{src.plane, dst.plane, size.width, size.height, neighbours == Neighbours::kEight};
  recorder.dispatch(kernel_, push, {reads(src), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
