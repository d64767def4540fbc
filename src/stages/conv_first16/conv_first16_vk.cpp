#include "stages/conv_first16/conv_first16_vk.h"

#include "stages/conv_first16/conv_first16_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kConvFirst16Code[] = {
#include "spirv/conv_first16.comp.inc"
};

}  // namespace

Result<ConvFirst16> ConvFirst16::make(const Device& device) {
  ConvFirst16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"conv_first16", kConvFirst16Code, 3, sizeof(ConvFirst16Push)}));
  return out;
}

void ConvFirst16::record(Recorder& recorder, const duo::ConvFirst16& layer, const Buffer& constants, std::size_t at,
                         const Tensors16& x, const Tensors16& y) const {
  DUO_CHECK(x.channels == 3 && y.channels == layer.outputs && x.held() && y.held() && x.pictures == y.pictures);
  DUO_CHECK(x.size.width == 2 * y.size.width && x.size.height == 2 * y.size.height);
  DUO_CHECK(4 * (at + packed_words(layer)) <= constants.bytes());
  const ConvFirst16Push push{x.view.plane,  y.view.plane,    static_cast<int>(at), layer.outputs,
                             layer.pad_top, layer.pad_left,  x.size.width,         x.size.height,
                             y.count(),     layer.range.low, layer.range.high};
  recorder.dispatch(kernel_, push, {reads(x.view), reads(constants), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
