// What two pixels are compared by in semi-global matching, as plain planes of bytes.
#pragma once

#include <array>
#include <cstdint>

#include "duoptic/image.h"

namespace duo {

/// One view. Census: bit k of both bytes tells whether neighbour k is darker than the pixel. Channels (gray, Sobel x, Sobel y):
/// the value, and the interval that it and the half-way values towards its four neighbours span.
///
/// Outside: 255 where the pixel cannot be compared, else 0.
///
/// Shape   all H x W; each row continues by its edge values for as many columns as PlaneImages::pad says on the left, and 64 on
///         the right
struct MatchPlanes {
  static constexpr int kChannels = 3;
  std::array<View<const std::uint8_t>, 2> census;
  std::array<View<const std::uint8_t>, kChannels> value, low, high;
  View<const std::uint8_t> outside;
  Size size() const { return value[0].size(); }
};

/// The memory of one view's planes: a row of all of them lies together, an odd number of cache lines apart, as who compares
/// pixels walks along all twelve at once. Twelve pictures a whole number of pages apart would share one set of the cache.
class PlaneImages {
 public:
  static constexpr int kPadRight = 64;
  Size size;
  int pad = 0;  // columns before x = 0
  std::array<View<std::uint8_t>, 2> census;
  std::array<View<std::uint8_t>, MatchPlanes::kChannels> value, low, high;
  View<std::uint8_t> outside;

  PlaneImages() = default;
  PlaneImages(Size size_, int pad_) : size(size_), pad(pad_) {
    constexpr int kLine = 64, kPlanes = 2 + 3 * MatchPlanes::kChannels + 1;
    const Size padded{pad + size.width + kPadRight, size.height};
    const int apart = (((padded.width + kLine - 1) / kLine) | 1) * kLine;
    memory_ = Image<std::uint8_t>({kPlanes * apart, padded.height});
    int n = 0;
    const auto next = [&] { return View<std::uint8_t>(memory_.row(0) + apart * n++, padded, memory_.stride()); };
    for (auto& plane : census) plane = next();
    for (auto* planes : {&value, &low, &high})
      for (auto& plane : *planes) plane = next();
    outside = next();
  }

  MatchPlanes planes() const {
    const auto inner = [this](View<const std::uint8_t> plane) { return plane.crop(0, pad, size); };
    MatchPlanes out;
    for (std::size_t i = 0; i < census.size(); ++i) out.census[i] = inner(census[i]);
    for (std::size_t i = 0; i < value.size(); ++i)
      out.value[i] = inner(value[i]), out.low[i] = inner(low[i]), out.high[i] = inner(high[i]);
    out.outside = inner(outside);
    return out;
  }

  /// Continues row y of a plane by its edge values.
  void continue_row(View<std::uint8_t> plane, int y) const {
    std::uint8_t* row = plane.row(y);
    std::memset(row, row[pad], static_cast<std::size_t>(pad));
    std::memset(row + pad + size.width, row[pad + size.width - 1], kPadRight);
  }

 private:
  Image<std::uint8_t> memory_;
};

}  // namespace duo
