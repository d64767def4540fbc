#include "nets/net_run.h"

#include "core/check.h"
#include "stages/depth_to_space16/depth_to_space16.h"
#include "stages/maxpool2x16/maxpool2x16.h"
#include "stages/resize2x16/resize2x16.h"
#include "stages/sum_pixels16/sum_pixels16.h"

namespace duo {
namespace {

/// One layer on plain loops.
struct RunPlain {
  ConstTensor16 x, b;
  Tensor16 y;
  void operator()(const ConvFirst16& layer) const { ref::conv_first16(layer, x, y); }
  void operator()(const Matmul16& layer) const { ref::matmul16(layer, x, y); }
  void operator()(const Depthwise16& layer) const { ref::depthwise16(layer, x, y); }
  void operator()(const Add16& layer) const { ref::add16(layer, x, b, y); }
  void operator()(const Resize2x16&) const { ref::resize2x16(x, y); }
  void operator()(const Maxpool2x16&) const { ref::maxpool2x16(x, y); }
  void operator()(const SumPixels16& layer) const { ref::sum_pixels16(x, layer.shift, y); }
  void operator()(const DepthToSpace16&) const { ref::depth_to_space16(x, y); }
};

}  // namespace

struct NetRun::Prepared {};

NetRun::NetRun(const Net& net, Loops loops)
    : net_(&net), loops_(loops), plan_(plan_memory(net)), memory_({static_cast<int>(plan_.count) + 64, 1}) {}
NetRun::~NetRun() = default;
NetRun::NetRun(NetRun&&) noexcept = default;

Tensor16 NetRun::tensor(int index) {
  const NetTensor& tensor = net_->tensors[index];
  return {memory_.row(0) + plan_.offsets[index], tensor.size, tensor.channels};
}

std::size_t NetRun::memory_bytes() const { return plan_.count * sizeof(std::int16_t); }

void NetRun::run(Pool&) {
  for (const NetLayer& layer : net_->layers) {
    Tensor16 x = tensor(layer.a);
    const Tensor16 y = tensor(layer.y);
    // Fully connected: all pixels are one.
    if (std::holds_alternative<Matmul16>(layer.work) && y.pixels() == 1) x = {x.data(), {1, 1}, static_cast<int>(x.count())};
    std::visit(RunPlain{x, layer.b < 0 ? ConstTensor16() : ConstTensor16(tensor(layer.b)), y}, layer.work);
  }
}

}  // namespace duo
