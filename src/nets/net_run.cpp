#include "nets/net_run.h"

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

/// One layer on the processor's vectors.
struct RunVectors {
  Pool& pool;
  ConstTensor16 x, b;
  Tensor16 y;
  void operator()(const ConvFirst16& layer) const { simd::conv_first16(pool, layer, x, y); }
  void operator()(const Matmul16& layer) const { simd::matmul16(pool, layer, x, y); }
  void operator()(const Depthwise16& layer) const { simd::depthwise16(pool, layer, x, y); }
  void operator()(const Add16& layer) const { simd::add16(pool, layer, x, b, y); }
  void operator()(const Resize2x16&) const { simd::resize2x16(pool, x, y); }
  void operator()(const Maxpool2x16&) const { simd::maxpool2x16(pool, x, y); }
  void operator()(const SumPixels16& layer) const { simd::sum_pixels16(pool, x, layer.shift, y); }
  void operator()(const DepthToSpace16&) const { simd::depth_to_space16(pool, x, y); }
};

/// Words of a layer's constants in the order of lanes; none for layers that take them as they are.
template <class Layer>
std::size_t words_of(const Layer& layer) {
  if constexpr (requires { packed_words(layer); }) return packed_words(layer);
  return 0;
}

template <class Layer>
void pack_layer(Layer& layer, std::span<std::int32_t> memory) {
  if constexpr (requires { pack(layer, memory); }) {
    pack(layer, memory);
    layer.packed = memory;
  }
}

}  // namespace

NetRun::NetRun(const Net& net, Loops loops)
    : net_(&net),
      loops_(loops),
      chains_(chains_of(net)),
      plan_(plan_memory(net)),
      memory_({static_cast<int>(plan_.count) + 64, 1}) {
  for (const NetLayer& layer : net.layers) works_.push_back(layer.work);
  if (loops_ == Loops::kPlain) return;
  const auto words = [](const LayerWork& work) { return std::visit([](const auto& layer) { return words_of(layer); }, work); };
  std::size_t all = 0;
  for (const LayerWork& work : works_) all += words(work);
  // One row, which begins at a multiple of 64 bytes; blocks of packed layers have that length, so that lanes load whole lines.
  packed_ = Image<std::int32_t>({static_cast<int>(all), 1});
  std::int32_t* at = packed_.row(0);
  for (LayerWork& work : works_) {
    const std::span memory(at, words(work));
    std::visit([&](auto& layer) { pack_layer(layer, memory); }, work);
    at += memory.size();
  }
}

Tensor16 NetRun::tensor(int index) {
  const NetTensor& tensor = net_->tensors[index];
  return {memory_.row(0) + plan_.offsets[index], tensor.size, tensor.channels};
}

std::size_t NetRun::memory_bytes() const { return plan_.count * sizeof(std::int16_t); }

void NetRun::run(Pool& pool) {
  if (loops_ == Loops::kPlain) return run_layers(pool);
  pool.together([&] { run_layers(pool); });
}

void NetRun::run_layers(Pool& pool) {
  for (std::size_t i = 0; i < works_.size(); ++i) {
    if (i > 0 && chains_[i] != chains_[i - 1]) pool.meet();
    const NetLayer& layer = net_->layers[i];
    Tensor16 x = tensor(layer.a);
    const Tensor16 y = tensor(layer.y);
    const ConstTensor16 b = layer.b < 0 ? ConstTensor16() : ConstTensor16(tensor(layer.b));
    // Fully connected: all pixels are one.
    if (std::holds_alternative<Matmul16>(layer.work) && y.pixels() == 1) x = {x.data(), {1, 1}, static_cast<int>(x.count())};
    if (loops_ == Loops::kPlain)
      std::visit(RunPlain{x, b, y}, works_[i]);
    else
      std::visit(RunVectors{pool, x, b, y}, works_[i]);
  }
}

}  // namespace duo
