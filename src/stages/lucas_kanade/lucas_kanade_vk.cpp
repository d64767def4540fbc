#include "stages/lucas_kanade/lucas_kanade_vk.h"

#include "stages/lucas_kanade/lucas_kanade_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kLucasKanadeCode[] = {
#include "spirv/lucas_kanade.comp.inc"
};

}  // namespace

Result<LucasKanade> LucasKanade::make(const Device& device) {
  LucasKanade out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"lucas kanade", kLucasKanadeCode, 5, sizeof(LucasKanadePush)}));
  return out;
}

void LucasKanade::record(Recorder& recorder, const Input& in, const Buffer& clear, BufferView<std::uint16_t> dst,
                         Size size) const {
  DUO_CHECK(in.left.holds(size) && in.right.holds(size) && in.d_q4.holds(size) && dst.holds(size) && in.max_disparity >= 1);
  const LucasKanadePush push{
      in.left.plane, in.right.plane, in.d_q4.plane, dst.plane, size.width, size.height, 16 * (in.max_disparity - 1)};
  recorder.dispatch(kernel_, push, {reads(in.left), reads(in.right), reads(in.d_q4), reads(clear), writes(dst)},
                    groups_for(size));
}

}  // namespace duo::vk
