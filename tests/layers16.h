// Random layers in 16-bit integers whose sums fit, with unequal shifts, biases and ranges, and values that reach both ends.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "core/tensor.h"
#include "stages/conv_first16/conv_first16.h"
#include "stages/depthwise16/depthwise16.h"
#include "stages/matmul16/matmul16.h"
#include "tests/agree.h"

namespace duo::test {

/// Values of which a third each are random, small, and +-32767.
inline std::vector<std::int16_t> values16(std::size_t count, std::mt19937& rng) {
  std::vector<std::int16_t> out(count);
  for (auto& value : out) {
    const int r = static_cast<int>(rng() % 65535) - 32767;
    value = static_cast<std::int16_t>(rng() % 3 == 0 ? r : rng() % 2 == 0 ? r % 5 : r < 0 ? -32767 : 32767);
  }
  return out;
}

/// What `terms` products of weights with values of 16 bits may sum up to: outputs x terms weights, of which each output has two
/// of full size, or as many as there are of such a size that they fit.
inline std::vector<std::int16_t> weights16(int outputs, int terms, std::mt19937& rng) {
  std::vector<std::int16_t> out(static_cast<std::size_t>(outputs) * terms);
  for (int n = 0; n < outputs; ++n) {
    std::int16_t* w = out.data() + static_cast<std::ptrdiff_t>(n) * terms;
    if (n % 3 == 0) {
      for (int i = 0; i < std::min(terms, 2); ++i) w[rng() % terms] = rng() % 2 ? 32767 : -32767;
      continue;
    }
    const int most = std::min(32767, 2 * 32767 / terms);
    for (int i = 0; i < terms; ++i) w[i] = static_cast<std::int16_t>(static_cast<int>(rng() % (2 * most + 1)) - most);
  }
  return out;
}

/// Biases and shifts of `count` outputs: the half that rounds and up to 2^15 more, below what two full products leave free.
struct Scales16 {
  std::vector<std::int32_t> bias;
  std::vector<std::uint8_t> shift;
  Scales16(int count, std::mt19937& rng) : bias(count), shift(count) {
    for (int n = 0; n < count; ++n) {
      shift[n] = static_cast<std::uint8_t>(n % 5 == 0 ? rng() % 32 : rng() % 18);
      bias[n] =
          static_cast<std::int32_t>(((std::int64_t{1} << shift[n]) >> 1) % 65536 + static_cast<int>(rng() % 65536) - 32768);
    }
  }
};

inline Range16 range16(std::mt19937& rng) {
  constexpr Range16 kRanges[] = {{-32767, 32767}, {0, 24576}, {0, 32767}, {-300, 20000}};
  return kRanges[rng() % 4];
}

struct RandomMatmul16 {
  std::vector<std::int16_t> weights;
  Scales16 scales;
  std::vector<std::int32_t> packed;
  Matmul16 layer;
  RandomMatmul16(int inputs, int outputs, std::mt19937& rng)
      : weights(weights16(outputs, inputs, rng)), scales(outputs, rng), layer{inputs,       outputs, weights, scales.bias,
                                                                              scales.shift, 0,       {}} {
    if (inputs > kMatmulChunk) layer.fold = static_cast<int>(rng() % 6);
    layer.range = range16(rng);
    packed.resize(packed_words(layer));
    pack(layer, packed);
    layer.packed = packed;
  }
  RandomMatmul16(const RandomMatmul16&) = delete;
  RandomMatmul16& operator=(const RandomMatmul16&) = delete;
};

struct RandomDepthwise16 {
  std::vector<std::int16_t> weights;
  Scales16 scales;
  Depthwise16 layer;
  RandomDepthwise16(int channels, int window, int stride, int pad_top, int pad_left, std::mt19937& rng)
      : weights(static_cast<std::size_t>(channels) * window * window), scales(channels, rng), layer{channels,    window,
                                                                                                    stride,      pad_top,
                                                                                                    pad_left,    weights,
                                                                                                    scales.bias, scales.shift,
                                                                                                    range16(rng)} {
    const int taps = window * window;
    const auto of_channels = weights16(channels, taps, rng);
    for (int c = 0; c < channels; ++c)
      for (int i = 0; i < taps; ++i) weights[i * channels + c] = of_channels[c * taps + i];
  }
  RandomDepthwise16(const RandomDepthwise16&) = delete;
  RandomDepthwise16& operator=(const RandomDepthwise16&) = delete;
};

struct RandomConvFirst16 {
  std::vector<std::int16_t> weights;
  Scales16 scales;
  std::vector<std::int32_t> packed;
  ConvFirst16 layer;
  RandomConvFirst16(int outputs, int pad_top, int pad_left, std::mt19937& rng)
      : weights(weights16(outputs, kFirstTaps, rng)), scales(outputs, rng), layer{outputs,     pad_top,     pad_left,
                                                                                  weights,     scales.bias, scales.shift,
                                                                                  range16(rng)} {
    packed.resize(packed_words(layer));
    pack(layer, packed);
    layer.packed = packed;
  }
  RandomConvFirst16(const RandomConvFirst16&) = delete;
  RandomConvFirst16& operator=(const RandomConvFirst16&) = delete;
};

/// A tensor with its memory, which ends where the tensor does.
struct Made16 {
  std::vector<std::int16_t> data;
  Tensor16 view;
  Made16(Size size, int channels, std::int16_t value = -1)
      : data(static_cast<std::size_t>(size.width) * size.height * channels, value), view(data.data(), size, channels) {}
  Made16(Size size, int channels, std::mt19937& rng) : Made16(size, channels) {
    data = values16(data.size(), rng);
    view = {data.data(), size, channels};
  }
  Made16(const Made16&) = delete;
  Made16& operator=(const Made16&) = delete;
};

/// Fails at the first value that differs.
inline void expect_same16(ConstTensor16 want, ConstTensor16 got, const std::string& what) {
  for (int y = 0; y < want.height(); ++y)
    for (int x = 0; x < want.width(); ++x)
      for (int c = 0; c < want.channels(); ++c)
        if (want.pixel(y, x)[c] != got.pixel(y, x)[c]) {
          ADD_FAILURE() << what << " " << want.width() << "x" << want.height() << "x" << want.channels() << " y=" << y
                        << " x=" << x << " c=" << c << ": want " << want.pixel(y, x)[c] << " got " << got.pixel(y, x)[c];
          return;
        }
}

/// Holds a stage's vectors against its plain loops: every instruction set, one and three threads. ref(y), simd(pool, y).
template <class Ref, class Simd>
void agree16(const std::string& what, Size size, int channels, Ref ref, Simd simd) {
  Made16 want(size, channels);
  ref(want.view);
  static Pool one(1), three(3);
  each_target([&](const std::string& target) {
    for (Pool* pool : {&one, &three}) {
      Made16 got(size, channels);
      simd(*pool, got.view);
      expect_same16(want.view, got.view, what + " simd " + target + " threads " + std::to_string(pool->threads()));
    }
  });
}

}  // namespace duo::test
