#include "nets/net_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/file.h"
#include "nets/net_check.h"

namespace duo {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are used where they lie");

constexpr std::string_view kNetMagic = "DUONET1\n";
constexpr std::size_t kNetHead = 16;         // magic and hash
constexpr std::size_t kMostFile = 64 << 20;  // twice the largest model
constexpr std::uint32_t kMostLayers = 2000;

/// Takes numbers one after the other. Past the end all are zero and cut() says so.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T take() {
    T value = {};
    if (at_ + sizeof(T) > bytes_.size())
      cut_ = true;
    else
      std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text(std::size_t size) {
    if (at_ + size > bytes_.size()) {
      cut_ = true;
      return {};
    }
    const std::string_view all = bytes_.substr(at_, size);
    at_ += size;
    return std::string(all.substr(0, std::min(all.find('\0'), all.size())));
  }
  void align() { at_ = (at_ + 7) / 8 * 8; }
  std::size_t at() const { return at_; }
  bool cut() const { return cut_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool cut_ = false;
};

/// A layer as its bytes are, before anything is known of it.
struct LayerBytes {
  std::uint16_t a, b, y;
  std::uint8_t kind, window, stride, top, left, left_a, left_b, shift, fold, zero;
  std::uint32_t at;
};
static_assert(sizeof(LayerBytes) == 20);

/// The constants of one layer, one after the other; nothing is given that lies outside.
class Constants {
 public:
  Constants(const std::uint64_t* data, std::size_t bytes, std::size_t at)
      : data_(reinterpret_cast<const char*>(data)), bytes_(bytes), at_(at) {}
  template <class T>
  std::span<const T> take(std::size_t count) {
    const std::size_t size = count * sizeof(T);
    if (at_ % 8 != 0 || at_ > bytes_ || size > bytes_ - at_) {
      outside_ = true;
      return {};
    }
    const std::span<const T> out(reinterpret_cast<const T*>(data_ + at_), count);
    at_ += (size + 7) / 8 * 8;
    return out;
  }
  bool outside() const { return outside_; }

 private:
  const char* data_;
  std::size_t bytes_, at_;
  bool outside_ = false;
};

/// Fills `work` in place: nothing is known of it yet but that its tensors exist.
void fill_work(const LayerBytes& bytes, const NetTensor& x, const NetTensor& y, Constants& constants, LayerWork& work) {
  const std::size_t outputs = y.channels;
  const auto learnt = [&](auto& layer, std::size_t weights_of_output) {
    layer.weights = constants.take<std::int16_t>(outputs * weights_of_output);
    layer.bias = constants.take<std::int32_t>(outputs);
    layer.shift = constants.take<std::uint8_t>(outputs);
    layer.range = y.range;
  };
  switch (bytes.kind) {
    case 0: {
      auto& layer = work.emplace<ConvFirst16>();
      layer.outputs = y.channels;
      layer.pad_top = bytes.top;
      layer.pad_left = bytes.left;
      learnt(layer, kFirstTaps);
      break;
    }
    case 1: {
      auto& layer = work.emplace<Matmul16>();
      // Of one pixel's result all pixels are inputs: fully connected.
      layer.inputs = static_cast<int>(y.size == Size{1, 1} ? x.count() : x.channels);
      layer.outputs = y.channels;
      layer.fold = bytes.fold;
      learnt(layer, layer.inputs);
      break;
    }
    case 2: {
      auto& layer = work.emplace<Depthwise16>();
      layer.channels = y.channels;
      layer.window = bytes.window;
      layer.stride = bytes.stride;
      layer.pad_top = bytes.top;
      layer.pad_left = bytes.left;
      learnt(layer, bytes.window * bytes.window);
      break;
    }
    case 3:
      work = Add16{bytes.left_a, bytes.left_b, bytes.shift, y.range};
      break;
    case 4:
      work = Resize2x16{};
      break;
    case 5:
      work = Maxpool2x16{};
      break;
    case 6:
      work = SumPixels16{bytes.shift};
      break;
    default:
      work = DepthToSpace16{};
  }
}

}  // namespace

std::uint64_t hash_words(std::string_view bytes) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
    hash = (hash ^ word) * 0x100000001B3;
  }
  return hash;
}

Result<Net> parse_net(std::string_view bytes, std::string_view name) {
  const auto error = [&](std::string_view why) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot use the network '{}': {}; take the file from the project again", name, why)};
  };
  if (bytes.size() < kNetHead || bytes.substr(0, kNetMagic.size()) != kNetMagic)
    return error("it is no network of Duoptic's, or of another version");
  ByteReader reader(bytes.substr(kNetHead));
  Net net;
  std::memcpy(&net.hash, bytes.data() + kNetMagic.size(), sizeof(net.hash));
  if (bytes.size() % 8 != 0 || hash_words(bytes.substr(kNetHead)) != net.hash)
    return error("it is cut or was changed: its hash is not what it says");
  net.name = reader.text(24);
  const auto tensors = reader.take<std::uint32_t>(), layers = reader.take<std::uint32_t>(),
             outputs = reader.take<std::uint32_t>();
  reader.take<std::uint32_t>();
  if (reader.cut() || layers < 1 || layers > kMostLayers || tensors != layers + 1 || outputs < 1 || outputs > tensors)
    return error("it has a wrong number of layers");
  for (std::uint32_t i = 0; i < tensors; ++i) {
    NetTensor tensor;
    tensor.size.height = reader.take<std::uint16_t>();
    tensor.size.width = reader.take<std::uint16_t>();
    tensor.channels = reader.take<std::uint16_t>();
    tensor.exponent = reader.take<std::int16_t>();
    tensor.range.low = reader.take<std::int16_t>();
    tensor.range.high = reader.take<std::int16_t>();
    net.tensors.push_back(tensor);
  }
  std::vector<LayerBytes> plan;
  for (std::uint32_t i = 0; i < layers; ++i) plan.push_back(reader.take<LayerBytes>());
  for (std::uint32_t i = 0; i < outputs; ++i) {
    NetOutput output{reader.text(14), 0};
    output.tensor = reader.take<std::uint16_t>();
    net.outputs.push_back(std::move(output));
  }
  reader.align();
  if (reader.cut() || reader.at() > bytes.size() - kNetHead) return error("it is cut");
  const std::string_view constants = bytes.substr(kNetHead + reader.at());
  net.constants = std::make_unique<std::uint64_t[]>((constants.size() + 7) / 8 + 1);  // aligned as the file is not
  if (!constants.empty()) std::memcpy(net.constants.get(), constants.data(), constants.size());

  if (const auto why = tensors_wrong(net)) return error(*why);
  for (std::uint32_t i = 0; i < layers; ++i) {
    const LayerBytes& layer = plan[i];
    if (layer.y != i + 1 || layer.a > i || (layer.kind == 3 ? layer.b > i : layer.b != 0xFFFF) ||
        layer.kind >= std::variant_size_v<LayerWork>)
      return error(fmt::format("layer {} is not one that can be run", i));
    Constants own(net.constants.get(), constants.size(), layer.at);
    NetLayer& added = net.layers.emplace_back();
    added.a = layer.a;
    added.b = layer.kind == 3 ? layer.b : -1;
    added.y = layer.y;
    fill_work(layer, net.tensors[added.a], net.tensors[added.y], own, added.work);
    if (own.outside()) return error(fmt::format("the constants of layer {} lie outside the file", i));
    if (const auto why = layer_wrong(net, added)) return error(fmt::format("layer {}: {}", i, *why));
  }
  return net;
}

Result<Net> read_net(const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const std::string bytes, read_file(path, kMostFile, "network"));
  return parse_net(bytes, path.string());
}

}  // namespace duo
