#include "nets/float_peer.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <xnnpack.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/check.h"

namespace duo {
namespace {

#if HWY_ARCH_X86_64
/// What cpuinfo, which XNNPACK asks, knows of the processor: bytes of 0 or 1 in an order of its own, whose header Debian leaves
/// out.
class KnownInstructions {
 public:
  KnownInstructions() {
    const auto initialize = reinterpret_cast<bool (*)()>(dlsym(RTLD_DEFAULT, "cpuinfo_initialize"));
    auto* const bytes = static_cast<std::uint8_t*>(dlsym(RTLD_DEFAULT, "cpuinfo_isa"));
    if (initialize != nullptr && bytes != nullptr && initialize() && is_as_known(bytes)) bytes_ = bytes;
  }
  bool found() const { return bytes_ != nullptr; }
  void forget_avx512() { std::memset(bytes_ + kAvx512, 0, kAvx512Count); }
  void forget_avx() { std::memset(bytes_ + kAvx, 0, kAvx512 - kAvx), forget_avx512(); }

 private:
  // AVX, FMA3, FMA4, XOP, F16C, AVX2; then AVX-512: F, PF, ER, CD, DQ, BW, VL, IFMA, VBMI, VBMI2, BITALG, VPOPCNTDQ, VNNI.
  static constexpr int kAvx = 22, kAvx512 = 28, kAvx512Count = 13;
  static bool is_as_known(const std::uint8_t* bytes) {
    const auto is = [&](int at, bool supported) { return bytes[at] == static_cast<std::uint8_t>(supported); };
    return is(16, __builtin_cpu_supports("sse3") != 0) && is(17, __builtin_cpu_supports("ssse3") != 0) &&
           is(18, __builtin_cpu_supports("sse4.1") != 0) && is(19, __builtin_cpu_supports("sse4.2") != 0) &&
           is(kAvx, __builtin_cpu_supports("avx") != 0) && is(kAvx + 1, __builtin_cpu_supports("fma") != 0) &&
           is(kAvx + 5, __builtin_cpu_supports("avx2") != 0) && is(kAvx512, __builtin_cpu_supports("avx512f") != 0) &&
           is(kAvx512 + 3, __builtin_cpu_supports("avx512cd") != 0) && is(kAvx512 + 4, __builtin_cpu_supports("avx512dq") != 0) &&
           is(kAvx512 + 5, __builtin_cpu_supports("avx512bw") != 0) && is(kAvx512 + 6, __builtin_cpu_supports("avx512vl") != 0) &&
           is(kAvx512 + 12, __builtin_cpu_supports("avx512vnni") != 0);
  }
  std::uint8_t* bytes_ = nullptr;
};

/// XNNPACK chooses its instructions when it is initialized: then it shall know of no more than our engines may use.
bool hold_to_our_instructions() {
  const std::int64_t targets = hwy::SupportedTargets();
  hwy::GetChosenTarget().Update(targets);  // the question lets all instructions in again, also those that somebody disabled
  const bool avx2 = (targets & HWY_AVX2) != 0, avx512 = (targets & (HWY_AVX3 | HWY_AVX3_DL)) != 0;
  if (avx512 || __builtin_cpu_supports("avx") == 0) return true;
  if (avx2 && __builtin_cpu_supports("avx512f") == 0) return true;
  KnownInstructions known;
  if (!known.found()) return false;
  avx2 ? known.forget_avx512() : known.forget_avx();
  return true;
}
#else
bool hold_to_our_instructions() { return true; }
#endif

void delete_operator(xnn_operator* op) { xnn_delete_operator(op); }
void delete_threads(pthreadpool* threads) { pthreadpool_destroy(threads); }

}  // namespace

FloatPeer::FloatPeer(const Net& net)
    : plan_(plan_memory(net)), memory_(plan_.count + XNN_EXTRA_BYTES), threads_(nullptr, delete_threads) {}

FloatPeer::~FloatPeer() = default;

// Makes one layer's operator; called with the layer.
struct FloatPeer::MakeLayer {
  const Net& net;
  const NetLayer& layer;
  FloatPeer& peer;
  std::vector<float>& factors;  // of each tensor: what its values here are multiplied with to be those of the network
  const NetTensor& a = net.tensors[layer.a];
  const NetTensor& y = net.tensors[layer.y];
  const float *x = peer.tensor(layer.a), *b = layer.b < 0 ? nullptr : peer.tensor(layer.b);
  float* out = peer.tensor(layer.y);
  pthreadpool* threads = peer.threads_.get();
  // Only ReLU6 has a range of its own: others saturate, which floats do not.
  const float low = y.range.low == 0 ? 0 : -std::numeric_limits<float>::infinity();
  const float high =
      y.range.low == 0 ? static_cast<float>(std::ldexp(y.range.high, -y.exponent)) : std::numeric_limits<float>::infinity();

  // Weights and biases of an output: q * 2^(x's exponent - fold - shift - y's), and without the half that rounds.
  float weight(int q, int fold, int shift) const {
    return static_cast<float>(std::ldexp(q, a.exponent - fold - shift - y.exponent)) * factors[layer.a];
  }
  float bias(std::int32_t q, int shift) const {
    return static_cast<float>(std::ldexp(q - (std::int64_t{1} << shift) / 2, -shift - y.exponent));
  }

  struct Window {
    int size = 1, stride = 1, top = 0, left = 0, groups = 1;
    std::uint32_t flags = 0;
  };

  xnn_status convolution(const std::vector<float>& weights, const std::vector<float>& biases, Window w, Size in, int channels,
                         xnn_operator_t* op) const {
    const auto after = [&](int outputs, int before, int inputs) {
      return static_cast<std::uint32_t>(std::max(0, (outputs - 1) * w.stride + w.size - before - inputs));
    };
    const auto unsigned_of = [](int value) { return static_cast<std::uint32_t>(value); };
    const std::uint32_t size = unsigned_of(w.size), stride = unsigned_of(w.stride);
    const xnn_status made = xnn_create_convolution2d_nhwc_f32(
        unsigned_of(w.top), after(y.size.width, w.left, in.width), after(y.size.height, w.top, in.height), unsigned_of(w.left),
        size, size, stride, stride, 1, 1, unsigned_of(w.groups), channels / w.groups, y.channels / w.groups, channels,
        y.channels, weights.data(), biases.data(), low, high, w.flags, op);
    if (made != xnn_status_success) return made;
    return xnn_setup_convolution2d_nhwc_f32(*op, 1, in.height, in.width, x, out, threads);
  }

  xnn_status operator()(const Matmul16& work, xnn_operator_t* op) const {
    std::vector<float> weights, biases;
    for (int n = 0; n < work.outputs; ++n) {
      for (int k = 0; k < work.inputs; ++k)
        weights.push_back(weight(work.weights[n * work.inputs + k], work.fold, work.shift[n]));
      biases.push_back(bias(work.bias[n], work.shift[n]));
    }
    return convolution(weights, biases, {}, y.size, work.inputs, op);
  }
  xnn_status operator()(const ConvFirst16& work, xnn_operator_t* op) const {
    std::vector<float> weights, biases;
    for (int n = 0; n < work.outputs; ++n) {
      for (int i = 0; i < kFirstTaps; ++i) weights.push_back(weight(work.weights[n * kFirstTaps + i], 0, work.shift[n]));
      biases.push_back(bias(work.bias[n], work.shift[n]));
    }
    return convolution(weights, biases, {3, 2, work.pad_top, work.pad_left}, a.size, 3, op);
  }
  xnn_status operator()(const Depthwise16& work, xnn_operator_t* op) const {
    std::vector<float> weights, biases;
    for (int i = 0; i < work.window * work.window; ++i)
      for (int c = 0; c < work.channels; ++c) weights.push_back(weight(work.weights[i * work.channels + c], 0, work.shift[c]));
    for (int c = 0; c < work.channels; ++c) biases.push_back(bias(work.bias[c], work.shift[c]));
    const Window window{work.window, work.stride, work.pad_top, work.pad_left, work.channels, XNN_FLAG_DEPTHWISE_CONVOLUTION};
    return convolution(weights, biases, window, a.size, work.channels, op);
  }
  xnn_status operator()(const Add16&, xnn_operator_t* op) const {
    const NetTensor& other = net.tensors[layer.b];
    if (other.channels != a.channels) return xnn_status_unsupported_parameter;
    const std::size_t count = a.count();
    if (const xnn_status made = xnn_create_add_nd_f32(low, high, 0, op); made != xnn_status_success) return made;
    return xnn_setup_add_nd_f32(*op, 1, &count, 1, &count, x, b, out, threads);
  }
  xnn_status operator()(const Resize2x16&, xnn_operator_t* op) const {
    const std::size_t c = a.channels;
    if (const xnn_status made = xnn_create_resize_bilinear2d_nhwc_f32(c, c, c, 0, op); made != xnn_status_success) return made;
    return xnn_setup_resize_bilinear2d_nhwc_f32(*op, 1, a.size.height, a.size.width, y.size.height, y.size.width, x, out,
                                                threads);
  }
  xnn_status operator()(const Maxpool2x16&, xnn_operator_t* op) const {
    const std::size_t c = a.channels;
    const xnn_status made = xnn_create_max_pooling2d_nhwc_f32(0, 0, 0, 0, 2, 2, 2, 2, 1, 1, c, c, c, low, high, 0, op);
    if (made != xnn_status_success) return made;
    return xnn_setup_max_pooling2d_nhwc_f32(*op, 1, a.size.height, a.size.width, x, out, threads);
  }
  xnn_status operator()(const SumPixels16& work, xnn_operator_t* op) const {
    const std::size_t c = a.channels, pixels = a.count() / c;
    factors[layer.y] = static_cast<float>(pixels) / static_cast<float>(1 << work.shift);  // the library divides by their number
    const float infinity = std::numeric_limits<float>::infinity();
    const xnn_status made = xnn_create_global_average_pooling_nwc_f32(c, c, c, -infinity, infinity, 0, op);
    if (made != xnn_status_success) return made;
    return xnn_setup_global_average_pooling_nwc_f32(*op, 1, pixels, x, out, threads);
  }
  xnn_status operator()(const DepthToSpace16&, xnn_operator_t* op) const {
    const std::size_t c = y.channels;
    if (const xnn_status made = xnn_create_depth_to_space_nhwc_x32(c, 4 * c, c, 2, 0, op); made != xnn_status_success)
      return made;
    return xnn_setup_depth_to_space_nhwc_x32(*op, 1, a.size.height, a.size.width, x, out, threads);
  }
};

Result<std::unique_ptr<FloatPeer>> FloatPeer::make(const Net& net, int threads) {
  static const bool held = hold_to_our_instructions();
  if (!held)
    return Error{ErrorCode::kUnsupported, "this build of XNNPACK cannot be held to the instructions that are asked for"};
  if (xnn_initialize(nullptr) != xnn_status_success)
    return Error{ErrorCode::kUnsupported, "XNNPACK does not run on this processor"};
  std::unique_ptr<FloatPeer> out(new FloatPeer(net));
  if (threads > 1) out->threads_.reset(pthreadpool_create(static_cast<std::size_t>(threads)));
  std::vector<float> factors(net.tensors.size(), 1);
  for (const NetLayer& layer : net.layers) {
    xnn_operator_t op = nullptr;
    const MakeLayer make{net, layer, *out, factors};
    const xnn_status status = std::visit([&](const auto& work) { return make(work, &op); }, layer.work);
    out->layers_.emplace_back(op, delete_operator);
    if (status != xnn_status_success)
      return Error{ErrorCode::kUnsupported, fmt::format("run {} with XNNPACK: it refuses layer {}", net.name, layer.y - 1)};
  }
  return out;
}

void FloatPeer::run() {
  for (const Operator& layer : layers_) DUO_CHECK(xnn_run_operator(layer.get(), threads_.get()) == xnn_status_success);
}

}  // namespace duo
