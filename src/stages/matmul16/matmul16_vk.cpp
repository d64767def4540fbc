#include "stages/matmul16/matmul16_vk.h"

#include "stages/matmul16/matmul16_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMatmul16Code[] = {
#include "spirv/matmul16.comp.inc"
};

}  // namespace

Result<Matmul16> Matmul16::make(const Device& device) {
  Matmul16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"matmul16", kMatmul16Code, 3, sizeof(Matmul16Push)}));
  return out;
}

void Matmul16::record(Recorder& recorder, const duo::Matmul16& layer, const Buffer& constants, std::size_t at,
                      const Tensors16& x, const Tensors16& y) const {
  DUO_CHECK(x.channels == layer.inputs && y.channels == layer.outputs && layer.inputs % 2 == 0);
  DUO_CHECK(x.held() && y.held() && x.pixels() == y.pixels() && x.pictures == y.pictures);
  DUO_CHECK(4 * (at + packed_words(layer)) <= constants.bytes());
  const Matmul16Push push{x.view.plane, y.view.plane, static_cast<int>(at), layer.inputs,    layer.outputs,
                          y.pixels(),   y.pictures,   layer.fold,           layer.range.low, layer.range.high};
  const Size groups{(y.pixels() * y.pictures + kTilePixels - 1) / kTilePixels,
                    (layer.outputs + kTileOutputs - 1) / kTileOutputs};
  recorder.dispatch(kernel_, push, {reads(x.view), reads(constants), writes(y.view)}, groups);
}

}  // namespace duo::vk
