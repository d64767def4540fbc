#include "stages/depthwise16/depthwise16_vk.h"

#include "stages/depthwise16/depthwise16_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kDepthwise16Code[] = {
#include "spirv/depthwise16.comp.inc"
};

}  // namespace

std::size_t packed_words(const duo::Depthwise16& layer) {
  return static_cast<std::size_t>(layer.channels) * (2 + (layer.window * layer.window + 1) / 2);
}

void pack(const duo::Depthwise16& layer, std::span<std::int32_t> packed) {
  DUO_CHECK(packed.size() == packed_words(layer));
  const int channels = layer.channels, places = layer.window * layer.window;
  for (int c = 0; c < channels; ++c) {
    packed[c] = layer.bias[c];
    packed[channels + c] = layer.shift[c];
    for (int i = 0; i < places; i += 2) {
      const std::uint32_t low = static_cast<std::uint16_t>(layer.weights[i * channels + c]);
      const std::uint32_t high = i + 1 < places ? static_cast<std::uint16_t>(layer.weights[(i + 1) * channels + c]) : 0;
      packed[(2 + i / 2) * channels + c] = static_cast<std::int32_t>(low | high << 16);
    }
  }
}

Result<Depthwise16> Depthwise16::make(const Device& device) {
  Depthwise16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"depthwise16", kDepthwise16Code, 3, sizeof(Depthwise16Push)}));
  return out;
}

void Depthwise16::record(Recorder& recorder, const duo::Depthwise16& layer, const Buffer& constants, std::size_t at,
                         const Tensors16& x, const Tensors16& y) const {
  DUO_CHECK(x.channels == layer.channels && y.channels == layer.channels && x.held() && y.held() && x.pictures == y.pictures);
  DUO_CHECK(4 * (at + packed_words(layer)) <= constants.bytes());
  const Depthwise16Push push{x.view.plane, y.view.plane,  static_cast<int>(at), layer.channels,  layer.window,
                             layer.stride, layer.pad_top, layer.pad_left,       x.size.width,    x.size.height,
                             y.size.width, y.count(),     layer.range.low,      layer.range.high};
  recorder.dispatch(kernel_, push, {reads(x.view), reads(constants), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
