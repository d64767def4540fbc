#include "nets/net_check.h"

#include <algorithm>

namespace duo {
namespace {

constexpr std::size_t kMostTensor = 16 << 20;  // values; the largest model has 1.2 million
constexpr std::size_t kMostTogether = 128 << 20;
constexpr int kMostChannels = 8192;

bool twice(const NetTensor& x, const NetTensor& y) {
  return y.size.width == 2 * x.size.width && y.size.height == 2 * x.size.height;
}

bool inside(Range16 inner, Range16 outer) { return inner.low >= outer.low && inner.high <= outer.high; }

/// What all layers with weights must have.
template <class Layer>
std::optional<std::string> learnt_wrong(const Layer& layer, const NetTensor& x) {
  if (std::ranges::find(layer.weights, -32768) != layer.weights.end()) return "a weight is -32768";
  if (std::ranges::any_of(layer.shift, [](int shift) { return shift > 31; })) return "a shift is above 31";
  if (!sums_fit(layer, x.range)) return "its sums do not fit 32 bits";
  return std::nullopt;
}

struct CheckLayer {
  const NetTensor &x, &y;
  const NetTensor* b;

  std::optional<std::string> operator()(const ConvFirst16& layer) const {
    if (x.channels != 3 || !twice(y, x) || layer.pad_top > 1 || layer.pad_left > 1) return "its sizes do not fit together";
    return learnt_wrong(layer, x);
  }
  std::optional<std::string> operator()(const Matmul16& layer) const {
    if (!(y.size == x.size) && !(y.size == Size{1, 1})) return "its sizes do not fit together";
    if (layer.fold > 15) return "its fold is above 15";
    return learnt_wrong(layer, x);
  }
  std::optional<std::string> operator()(const Depthwise16& layer) const {
    if (layer.window != 3 && layer.window != 5) return "its window is neither 3 nor 5";
    if (layer.stride != 1 && layer.stride != 2) return "its stride is neither 1 nor 2";
    if (layer.pad_top >= layer.window || layer.pad_left >= layer.window) return "its border is wider than its window";
    const auto fits = [&](int from, int to, int pad) {  // the last window begins inside
      return (to - 1) * layer.stride - pad < from;
    };
    if (x.channels != y.channels || !fits(x.size.height, y.size.height, layer.pad_top) ||
        !fits(x.size.width, y.size.width, layer.pad_left))
      return "its sizes do not fit together";
    return learnt_wrong(layer, x);
  }
  std::optional<std::string> operator()(const Add16& layer) const {
    if (!(x.size == y.size) || !(b->size == y.size) || x.channels != y.channels || b->channels > y.channels)
      return "its sizes do not fit together";
    if (layer.left_a > 14 || layer.left_b > 14 || layer.shift > 15) return "its shifts are too large";
    return std::nullopt;
  }
  std::optional<std::string> operator()(const Resize2x16&) const {
    if (!twice(x, y) || x.channels != y.channels || !inside(x.range, y.range)) return "its sizes do not fit together";
    return std::nullopt;
  }
  std::optional<std::string> operator()(const Maxpool2x16&) const {
    if (!twice(y, x) || x.channels != y.channels || !inside(x.range, y.range)) return "its sizes do not fit together";
    return std::nullopt;
  }
  std::optional<std::string> operator()(const SumPixels16& layer) const {
    if (!(y.size == Size{1, 1}) || x.channels != y.channels || !inside(x.range, y.range))
      return "its sizes do not fit together";
    if (layer.shift > 15 || x.size.width * x.size.height > 1 << layer.shift) return "its sum does not fit";
    return std::nullopt;
  }
  std::optional<std::string> operator()(const DepthToSpace16&) const {
    if (!twice(x, y) || x.channels != 4 * y.channels || !inside(x.range, y.range)) return "its sizes do not fit together";
    return std::nullopt;
  }
};

}  // namespace

std::optional<std::string> tensors_wrong(const Net& net) {
  std::size_t together = 0;
  for (const NetTensor& tensor : net.tensors) {
    if (tensor.size.empty() || tensor.channels < 1 || tensor.channels > kMostChannels || tensor.count() > kMostTensor)
      return "a tensor has no size, or too large a one";
    if (tensor.range.low > 0 || tensor.range.high < 0 || tensor.range.low == -32768) return "a tensor's range lacks 0";
    if (tensor.exponent < -15 || tensor.exponent > 30) return "a tensor's step is out of reason";
    together += tensor.count();
  }
  if (together > kMostTogether) return "it needs too much memory";
  for (const NetOutput& output : net.outputs)
    if (output.tensor < 1 || output.tensor >= static_cast<int>(net.tensors.size())) return "an output is no layer's result";
  return std::nullopt;
}

std::optional<std::string> layer_wrong(const Net& net, const NetLayer& layer) {
  const NetTensor* b = layer.b < 0 ? nullptr : &net.tensors[layer.b];
  return std::visit(CheckLayer{net.tensors[layer.a], net.tensors[layer.y], b}, layer.work);
}

}  // namespace duo
