#pragma once

#include "stages/rectify/rectify.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Rectification on a device; the contract is in rectify.h.
class Rectify {
 public:
  /// ResampleMap on the device.
  struct Map {
    BufferView<std::uint32_t> corner;
    BufferView<std::uint16_t> fraction_q8;
    ResampleMap::Columns columns = ResampleMap::Columns::kLinear;
    int raw_height = 0;  // of no matter to kLinear
  };
  static Result<Rectify> make(const Device& device);
  /// `size` is that of the map; what the map says must lie inside `src`. `inside` may be absent: it is the same each time.
  void record(Recorder& recorder, BufferView<std::uint8_t> src, const Map& map, BufferView<std::uint8_t> dst,
              BufferView<std::uint8_t> inside, Size size) const;
  void record(Recorder& recorder, BufferView<Rgb8> src, const Map& map, BufferView<Rgb8> dst, Size size) const;

 private:
  Kernel gray_, color_;
};

}  // namespace duo::vk
