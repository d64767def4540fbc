#pragma once

#include <cstddef>
#include <span>

#include "stages/region/region.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Connected regions of several bits on a device; the contract is in region.h.
class Region {
 public:
  /// A forest for each of up to `regions` windows of at most so many pixels, whatever their shape.
  class Scratch {
   public:
    static Result<Scratch> make(const Device& device, Size largest_window, int regions);

   private:
    friend class Region;
    Buffer forest_;
    int room_ = 0, regions_ = 0;
  };
  static Result<Region> make(const Device& device);
  /// Regions of different bits, of which all that changes from frame to frame lies in `tasks`, as write() leaves it there. A
  /// window with more pixels than the scratch has room for counts as empty.
  ///
  /// results: RegionLabel[count]
  void record(Recorder& recorder, const Buffer& tasks, int count, BufferView<std::uint8_t> marks, const Scratch& scratch,
              const Buffer& results, Size size) const;

  static std::size_t task_bytes(int count);
  /// Regions of different bits; seeds closer than 2^15 px to every pixel along x and y. Tasks beyond
  /// those given get an empty window.
  static void write(std::span<const duo::Region> regions, std::span<std::byte> tasks);

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
