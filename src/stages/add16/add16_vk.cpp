#include "stages/add16/add16_vk.h"

#include "stages/add16/add16_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kAdd16Code[] = {
#include "spirv/add16.comp.inc"
};

}  // namespace

Result<Add16> Add16::make(const Device& device) {
  Add16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"add16", kAdd16Code, 3, sizeof(Add16Push)}));
  return out;
}

void Add16::record(Recorder& recorder, const duo::Add16& layer, const Tensors16& a, const Tensors16& b,
                   const Tensors16& y) const {
  DUO_CHECK(a.size == y.size && b.size == y.size && a.channels == y.channels && b.channels <= y.channels);
  DUO_CHECK(a.held() && b.held() && y.held() && a.pictures == y.pictures && b.pictures == y.pictures);
  const Add16Push push{a.view.plane, b.view.plane, y.view.plane, y.channels,      b.channels,      y.count(),
                       layer.left_a, layer.left_b, layer.shift,  layer.range.low, layer.range.high};
  recorder.dispatch(kernel_, push, {reads(a.view), reads(b.view), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
