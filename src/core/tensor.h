// Activations between the layers of a network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "duoptic/image.h"

namespace duo {

/// A picture of vectors that it does not own: H x W pixels, each of C channels side by side, without gaps.
///
/// Units  int16 in steps of a power of two that the layers agree on; 0 means 0; -32768 never occurs
template <class T>
class TensorView {
 public:
  TensorView() = default;
  TensorView(T* data, Size size, int channels) : data_(data), size_(size), channels_(channels) {}
  template <class U>
  requires(std::is_same_v<T, const U>) TensorView(const TensorView<U>& other)  // NOLINT: implicit like T* -> const T*
      : data_(other.data()), size_(other.size()), channels_(other.channels()) {}

  T* data() const { return data_; }
  Size size() const { return size_; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  int channels() const { return channels_; }
  int pixels() const { return size_.width * size_.height; }
  std::size_t count() const { return static_cast<std::size_t>(pixels()) * channels_; }
  /// The channels of a pixel; pixels are numbered row by row.
  T* pixel(int index) const { return data_ + static_cast<std::ptrdiff_t>(index) * channels_; }
  T* pixel(int y, int x) const { return pixel(y * size_.width + x); }

 private:
  T* data_ = nullptr;
  Size size_;
  int channels_ = 0;
};

using Tensor16 = TensorView<std::int16_t>;
using ConstTensor16 = TensorView<const std::int16_t>;

/// The values that a layer's result may take; what lies outside becomes the nearest.
struct Range16 {
  std::int16_t low = -32767, high = 32767;
  friend bool operator==(const Range16&, const Range16&) = default;
  std::int16_t clamp(std::int32_t value) const {
    return static_cast<std::int16_t>(value < low ? low : value > high ? high : value);
  }
  /// Bounds of the sum of products of weights with values of this range: the weights above 0 sum to `positive`, those below to
  /// `negative`.
  std::int64_t least(std::int64_t positive, std::int64_t negative) const { return positive * low + negative * high; }
  std::int64_t most(std::int64_t positive, std::int64_t negative) const { return positive * high + negative * low; }
};

}  // namespace duo
