#include "nets/net_vk.h"

#include "core/check.h"

namespace duo::vk {
namespace {

/// What a layer's kernel reads, in 32-bit words; none for layers without constants.
template <class Layer>
std::vector<std::int32_t> packed_on_device(const Layer& layer) {
  std::vector<std::int32_t> words;
  if constexpr (requires { pack(layer, std::span<std::int32_t>()); }) {
    words.resize(packed_words(layer));
    pack(layer, words);
  }
  return words;
}

}  // namespace

Result<std::unique_ptr<DeviceNet>> DeviceNet::make(Device& device, const Net& net, int pictures) {
  DUO_CHECK(pictures >= 1);
  std::unique_ptr<DeviceNet> out(new DeviceNet(net, pictures));
  DUO_TRY(out->make_kernels(device));
  DUO_TRY(out->make_constants(device));
  DUO_TRY(out->make_memory(device));
  DUO_TRY(out->record_run(device));
  device.keep_pipelines();
  return out;
}

Result<void> DeviceNet::make_kernels(const Device& device) {
  DUO_TRY_ASSIGN(matmul_, Matmul16::make(device));
  DUO_TRY_ASSIGN(depthwise_, Depthwise16::make(device));
  DUO_TRY_ASSIGN(conv_first_, ConvFirst16::make(device));
  DUO_TRY_ASSIGN(add_, Add16::make(device));
  DUO_TRY_ASSIGN(resize_, Resize2x16::make(device));
  DUO_TRY_ASSIGN(maxpool_, Maxpool2x16::make(device));
  DUO_TRY_ASSIGN(depth_to_space_, DepthToSpace16::make(device));
  DUO_TRY_ASSIGN(sum_pixels_, SumPixels16::make(device));
  return {};
}

Result<void> DeviceNet::make_constants(Device& device) {
  std::vector<std::int32_t> words = {0};  // a buffer is not empty
  for (const NetLayer& layer : net_->layers) {
    constants_at_.push_back(words.size());
    const auto packed = std::visit([](const auto& work) { return packed_on_device(work); }, layer.work);
    words.insert(words.end(), packed.begin(), packed.end());
  }
  DUO_TRY_ASSIGN(constants_, make_filled(device, "network", std::as_bytes(std::span(words))));
  return {};
}

Result<void> DeviceNet::make_memory(const Device& device) {
  output_at_.assign(net_->tensors.size(), -1);
  for (const NetOutput& output : net_->outputs) {
    if (output_at_[output.tensor] >= 0) continue;
    output_at_[output.tensor] = static_cast<std::ptrdiff_t>(output_count_);
    output_count_ += net_->tensors[output.tensor].count();
  }
  const auto bytes = [&](std::size_t values) { return values * static_cast<std::size_t>(pictures_) * sizeof(std::int16_t); };
  const std::size_t input = bytes(net_->tensors[0].count()), outputs = bytes(output_count_);
  DUO_TRY_ASSIGN(memory_, Buffer::make(device, "activations", bytes(plan_.count), Memory::kDevice));
  DUO_TRY_ASSIGN(input_, Buffer::make(device, "network input", input, Memory::kDevice));
  DUO_TRY_ASSIGN(input_up_, Buffer::make(device, "network input up", input, Memory::kUpload));
  DUO_TRY_ASSIGN(outputs_, Buffer::make(device, "network outputs", outputs, Memory::kDevice));
  DUO_TRY_ASSIGN(outputs_down_, Buffer::make(device, "network outputs down", outputs, Memory::kDownload));
  return {};
}

Result<void> DeviceNet::record_run(Device& device) {
  DUO_TRY_ASSIGN(Recorder recorder, Recorder::make(device));
  recorder_ = std::make_unique<Recorder>(std::move(recorder));
  recorder_->begin();
  recorder_->copy(input_up_, input_, input_.bytes());
  record(*recorder_);
  recorder_->copy(outputs_, outputs_down_, outputs_.bytes());
  return recorder_->end();
}

Tensor16 DeviceNet::input(int picture) {
  const NetTensor& tensor = net_->tensors[0];
  return {reinterpret_cast<std::int16_t*>(input_up_.mapped().data()) + picture * tensor.count(), tensor.size, tensor.channels};
}

ConstTensor16 DeviceNet::output(int index, int picture) const {
  DUO_CHECK(output_at_[index] >= 0);
  const NetTensor& tensor = net_->tensors[index];
  const auto* values = reinterpret_cast<const std::int16_t*>(outputs_down_.mapped().data());
  return {values + picture * output_count_ + output_at_[index], tensor.size, tensor.channels};
}

Tensors16 DeviceNet::on_device(int index) const {
  const NetTensor& tensor = net_->tensors[index];
  const auto in = [&](const Buffer& buffer, std::size_t at, std::size_t count) {
    const Plane plane{static_cast<int>(at), static_cast<int>(count)};
    return Tensors16{{buffer, plane}, tensor.size, tensor.channels, pictures_};
  };
  if (output_at_[index] >= 0) return in(outputs_, static_cast<std::size_t>(output_at_[index]), output_count_);
  if (index == 0) return in(input_, 0, tensor.count());
  return in(memory_, plan_.offsets[index], plan_.count);
}

void DeviceNet::record(Recorder& recorder) const {
  struct RecordLayer {
    const DeviceNet& net;
    Recorder& recorder;
    std::size_t at;
    Tensors16 x, b, y;
    void operator()(const duo::ConvFirst16& layer) const { net.conv_first_.record(recorder, layer, net.constants_, at, x, y); }
    void operator()(const duo::Matmul16& layer) const { net.matmul_.record(recorder, layer, net.constants_, at, x, y); }
    void operator()(const duo::Depthwise16& layer) const { net.depthwise_.record(recorder, layer, net.constants_, at, x, y); }
    void operator()(const duo::Add16& layer) const { net.add_.record(recorder, layer, x, b, y); }
    void operator()(const duo::Resize2x16&) const { net.resize_.record(recorder, x, y); }
    void operator()(const duo::Maxpool2x16&) const { net.maxpool_.record(recorder, x, y); }
    void operator()(const duo::SumPixels16& layer) const { net.sum_pixels_.record(recorder, x, layer.shift, y); }
    void operator()(const duo::DepthToSpace16&) const { net.depth_to_space_.record(recorder, x, y); }
  };
  for (std::size_t i = 0; i < net_->layers.size(); ++i) {
    const NetLayer& layer = net_->layers[i];
    RecordLayer work{*this, recorder, constants_at_[i], on_device(layer.a), {}, on_device(layer.y)};
    if (layer.b >= 0) work.b = on_device(layer.b);
    // Fully connected: all pixels are one.
    if (std::holds_alternative<duo::Matmul16>(layer.work) && work.y.pixels() == 1) {
      work.x.channels = work.x.count();
      work.x.size = {1, 1};
    }
    std::visit(work, layer.work);
  }
}

}  // namespace duo::vk
