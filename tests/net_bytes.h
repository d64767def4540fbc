// A small network as the bytes of its file.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "nets/net_file.h"

namespace duo::test {

template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

struct TensorBytes {
  std::uint16_t height, width, channels;
  std::int16_t exponent = 0, low = -32767, high = 32767;
};
struct LayerBytes {
  std::uint16_t a, b, y;
  std::uint8_t kind, window = 0, stride = 0, top = 0, left = 0, left_a = 0, left_b = 0, shift = 0, fold = 0, zero = 0;
  std::uint32_t at = 0;
};

/// Everything of a file but its hash, to be changed before it is closed.
struct NetBytes {
  std::string name = "small";
  std::vector<TensorBytes> tensors;
  std::vector<LayerBytes> layers;
  std::vector<std::pair<std::string, std::uint16_t>> outputs;
  std::string constants;

  /// Adds a layer's constants and says where they begin.
  std::uint32_t add(const std::vector<std::int16_t>& weights, const std::vector<std::int32_t>& bias,
                    const std::vector<std::uint8_t>& shift) {
    const auto at = static_cast<std::uint32_t>(constants.size());
    const auto padded = [&](const auto& values) {
      for (const auto value : values) put(constants, value);
      constants.resize((constants.size() + 7) / 8 * 8);
    };
    padded(weights);
    padded(bias);
    padded(shift);
    return at;
  }
  std::string body() const {
    std::string out = name;
    out.resize(24);
    for (const std::size_t count : {tensors.size(), layers.size(), outputs.size(), std::size_t{0}})
      put(out, static_cast<std::uint32_t>(count));
    for (const TensorBytes& tensor : tensors) put(out, tensor);
    for (const LayerBytes& layer : layers) put(out, layer);
    for (const auto& [output, tensor] : outputs) {
      std::string padded = output;
      padded.resize(14);
      out += padded;
      put(out, tensor);
    }
    out.resize((out.size() + 7) / 8 * 8);
    return out + constants;
  }
  static std::string close(const std::string& body) {
    std::string out = "DUONET1\n";
    put(out, hash_words(body));
    return out + body;
  }
  std::string bytes() const { return close(body()); }
};

/// 2 x 2 pixels of 3 channels -> first convolution to 1 pixel of 2 -> fully connected to 1 -> added to itself.
inline NetBytes small_net() {
  NetBytes net;
  net.tensors = {{2, 2, 3}, {1, 1, 2}, {1, 1, 1}, {1, 1, 1}};
  std::vector<std::int16_t> first(54);
  for (int i = 0; i < 9; ++i) first[3 * i] = 1;  // the first output: all red; the second: green of the middle
  first[27 + 3 * 4 + 1] = 1;
  const std::uint32_t at_first = net.add(first, {0, 0}, {0, 0});
  const std::uint32_t at_second = net.add({2, -3}, {1}, {1});
  net.layers = {{0, 0xFFFF, 1, 0, 3, 2, 1, 1}, {1, 0xFFFF, 2, 1}, {2, 2, 3, 3}};
  net.layers[0].at = at_first;
  net.layers[1].at = at_second;
  net.outputs = {{"sum", 3}};
  return net;
}

}  // namespace duo::test
