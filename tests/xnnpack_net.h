// A network of ours in floating point on XNNPACK: a peer for speed, and for what the integers between the layers cost.
#pragma once

#include <gtest/gtest.h>
#include <xnnpack.h>

#include <cmath>
#include <deque>
#include <limits>
#include <vector>

#include "nets/net.h"

namespace duo::test {

class XnnpackNet {
 public:
  explicit XnnpackNet(const Net& net) : net_(net) {
    check(xnn_initialize(nullptr));
    check(xnn_create_subgraph(static_cast<std::uint32_t>(net.tensors.size()), 0, &graph_));
    ids_.resize(net.tensors.size(), XNN_INVALID_VALUE_ID);
    for (std::size_t i = 0; i < net.tensors.size(); ++i) define(static_cast<int>(i));
    for (const NetLayer& layer : net.layers) std::visit([&](const auto& work) { add(layer, work); }, layer.work);
    check(xnn_create_runtime(graph_, &runtime_));
    check(xnn_setup_runtime(runtime_, external_.size(), external_.data()));
  }
  ~XnnpackNet() {
    xnn_delete_runtime(runtime_);
    xnn_delete_subgraph(graph_);
  }
  XnnpackNet(const XnnpackNet&) = delete;
  XnnpackNet& operator=(const XnnpackNet&) = delete;

  /// The input and the outputs; others have no memory of their own.
  std::vector<float>& tensor(int index) {
    for (auto& [tensor, values] : values_)
      if (tensor == index) return values;
    ADD_FAILURE() << "tensor " << index << " has no memory";
    return values_.front().second;
  }
  void run() { check(xnn_invoke_runtime(runtime_)); }

 private:
  static void check(xnn_status status) { ASSERT_EQ(status, xnn_status_success); }
  const NetTensor& at(int tensor) const { return net_.tensors[tensor]; }

  void define(int tensor) {
    const std::size_t dims[] = {1, static_cast<std::size_t>(at(tensor).size.height),
                                static_cast<std::size_t>(at(tensor).size.width), static_cast<std::size_t>(at(tensor).channels)};
    bool output = false;
    for (const NetOutput& each : net_.outputs) output |= each.tensor == tensor;
    const bool external = tensor == 0 || output;
    const std::uint32_t flags = tensor == 0 ? XNN_VALUE_FLAG_EXTERNAL_INPUT : output ? XNN_VALUE_FLAG_EXTERNAL_OUTPUT : 0;
    check(xnn_define_tensor_value(graph_, xnn_datatype_fp32, 4, dims, nullptr,
                                  external ? static_cast<std::uint32_t>(tensor) : XNN_INVALID_VALUE_ID, flags, &ids_[tensor]));
    if (!external) return;
    values_.emplace_back(tensor, std::vector<float>(at(tensor).count() + XNN_EXTRA_BYTES));
    external_.push_back({ids_[tensor], values_.back().second.data()});
  }
  std::uint32_t constant(std::vector<float> values, std::vector<std::size_t> dims) {
    constants_.push_back(std::move(values));
    std::uint32_t id = XNN_INVALID_VALUE_ID;
    check(xnn_define_tensor_value(graph_, xnn_datatype_fp32, dims.size(), dims.data(), constants_.back().data(),
                                  XNN_INVALID_VALUE_ID, 0, &id));
    return id;
  }
  float least(int tensor) const { return at(tensor).range.low == 0 ? 0 : -std::numeric_limits<float>::infinity(); }
  float most(int tensor) const {
    return at(tensor).range.low == 0 ? std::ldexp(static_cast<float>(at(tensor).range.high), -at(tensor).exponent)
                                     : std::numeric_limits<float>::infinity();
  }
  /// Of a layer's output: an integer weight of 1 and a bias of 1 in floating point.
  double weight_step(const NetLayer& layer, int shift, int fold) const {
    return std::ldexp(1.0, at(layer.a).exponent - at(layer.y).exponent - shift - fold) * sum_scale(layer.a);
  }
  double bias_step(const NetLayer& layer, int shift) const { return std::ldexp(1.0, -at(layer.y).exponent - shift); }
  /// A global mean is a sum that is not divided by the number of pixels but shifted.
  double sum_scale(int tensor) const {
    if (tensor == 0) return 1;
    const NetLayer& from = net_.layers[tensor - 1];
    const auto* sum = std::get_if<SumPixels16>(&from.work);
    return sum == nullptr ? 1 : at(from.a).size.width * at(from.a).size.height / std::ldexp(1.0, sum->shift);
  }
  template <class Work>
  std::vector<float> biases(const NetLayer& layer, const Work& work) const {
    std::vector<float> out;
    for (std::size_t n = 0; n < work.bias.size(); ++n) {
      const std::int64_t half = (std::int64_t{1} << work.shift[n]) / 2;
      out.push_back(static_cast<float>(static_cast<double>(work.bias[n] - half) * bias_step(layer, work.shift[n])));
    }
    return out;
  }
  /// Rows and columns behind the last that a window reaches.
  std::uint32_t after(int from, int to, int window, int stride, int before) const {
    return static_cast<std::uint32_t>(std::max((to - 1) * stride + window - before - from, 0));
  }
  template <class Work>
  void convolve(const NetLayer& layer, const Work& work, int height, int width, int stride, int top, int left, int fold,
                std::size_t terms) {
    std::vector<float> weights;
    for (std::size_t i = 0; i < work.weights.size(); ++i)
      weights.push_back(static_cast<float>(work.weights[i] * weight_step(layer, work.shift[i / terms], fold)));
    const std::size_t outputs = work.bias.size(), channels = terms / (height * width);
    const NetTensor &x = at(layer.a), &y = at(layer.y);
    check(xnn_define_convolution_2d(
        graph_, top, after(x.size.width, y.size.width, width, stride, left),
        after(x.size.height, y.size.height, height, stride, top), left, height, width, stride, stride, 1, 1, 1, channels,
        outputs, least(layer.y), most(layer.y), ids_[layer.a],
        constant(std::move(weights), {outputs, static_cast<std::size_t>(height), static_cast<std::size_t>(width), channels}),
        constant(biases(layer, work), {outputs}), ids_[layer.y], 0));
  }
  void add(const NetLayer& layer, const ConvFirst16& work) {
    convolve(layer, work, 3, 3, 2, work.pad_top, work.pad_left, 0, kFirstTaps);
  }
  void add(const NetLayer& layer, const Matmul16& work) {
    const Size window = at(layer.y).size == Size{1, 1} ? at(layer.a).size : Size{1, 1};
    convolve(layer, work, window.height, window.width, 1, 0, 0, work.fold, static_cast<std::size_t>(work.inputs));
  }
  void add(const NetLayer& layer, const Depthwise16& work) {
    std::vector<float> weights;
    for (std::size_t i = 0; i < work.weights.size(); ++i)
      weights.push_back(static_cast<float>(work.weights[i] * weight_step(layer, work.shift[i % work.channels], 0)));
    const auto channels = static_cast<std::size_t>(work.channels), window = static_cast<std::size_t>(work.window);
    const NetTensor &x = at(layer.a), &y = at(layer.y);
    check(xnn_define_depthwise_convolution_2d(
        graph_, work.pad_top, after(x.size.width, y.size.width, work.window, work.stride, work.pad_left),
        after(x.size.height, y.size.height, work.window, work.stride, work.pad_top), work.pad_left, work.window, work.window,
        work.stride, work.stride, 1, 1, 1, channels, least(layer.y), most(layer.y), ids_[layer.a],
        constant(std::move(weights), {1, window, window, channels}), constant(biases(layer, work), {channels}), ids_[layer.y],
        0));
  }
  void add(const NetLayer& layer, const Add16&) {
    ASSERT_EQ(at(layer.a).channels, at(layer.b).channels);
    check(xnn_define_add2(graph_, least(layer.y), most(layer.y), ids_[layer.a], ids_[layer.b], ids_[layer.y], 0));
  }
  void add(const NetLayer& layer, const Resize2x16&) {
    check(xnn_define_static_resize_bilinear_2d(graph_, at(layer.y).size.height, at(layer.y).size.width, ids_[layer.a],
                                               ids_[layer.y], 0));
  }
  void add(const NetLayer& layer, const Maxpool2x16&) {
    check(xnn_define_max_pooling_2d(graph_, 0, 0, 0, 0, 2, 2, 2, 2, 1, 1, -std::numeric_limits<float>::infinity(),
                                    std::numeric_limits<float>::infinity(), ids_[layer.a], ids_[layer.y], 0));
  }
  void add(const NetLayer& layer, const SumPixels16&) {
    check(xnn_define_global_average_pooling_2d(graph_, -std::numeric_limits<float>::infinity(),
                                               std::numeric_limits<float>::infinity(), ids_[layer.a], ids_[layer.y], 0));
  }
  void add(const NetLayer& layer, const DepthToSpace16&) {
    check(xnn_define_depth_to_space(graph_, ids_[layer.a], ids_[layer.y], 2, 0));
  }

  const Net& net_;
  xnn_subgraph_t graph_ = nullptr;
  xnn_runtime_t runtime_ = nullptr;
  std::vector<std::uint32_t> ids_;
  std::deque<std::vector<float>> constants_;  // XNNPACK reads them where they are
  std::deque<std::pair<int, std::vector<float>>> values_;
  std::vector<xnn_external_value> external_;
};

}  // namespace duo::test
