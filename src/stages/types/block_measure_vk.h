// A number of a pair from blocks of its pictures, on a device: what noise and blur have in common.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "stages/types/block_measure_params.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// One kernel measures each block of both pictures and counts it in a bin, another makes the number of the bins.
class BlockMeasure {
 public:
  struct Source {
    std::string name;
    std::span<const std::uint32_t> count_code, number_code;
    int share = 0;                  // one block of so many is at or below a picture's level
    std::uint32_t of_no_block = 0;  // the number of pictures that are too small for a block
  };
  /// The bins; for each recording that may run at the same time as another.
  class Scratch {
   public:
    /// Errors  out of memory
    static Result<Scratch> make(const Device& device, const std::string& name, int bins) {
      Scratch out;
      DUO_TRY_ASSIGN(out.bins_, Buffer::make(device, name + " bins", sizeof(std::uint32_t) * static_cast<std::size_t>(bins),
                                             Memory::kDevice));
      return out;
    }

   private:
    friend BlockMeasure;
    Buffer bins_;
  };

  /// Errors  the driver refuses the shaders
  static Result<BlockMeasure> make(const Device& device, const Source& source) {
    BlockMeasure out;
    out.source_ = source;
    DUO_TRY_ASSIGN(out.count_,
                   Kernel::make(device, {(source.name + " blocks").c_str(), source.count_code, 3, sizeof(CountBlocksPush)}));
    DUO_TRY_ASSIGN(out.number_, Kernel::make(device, {source.name.c_str(), source.number_code, 2, sizeof(QuantilePush)}));
    return out;
  }
  /// `blocks`: of one picture; `number`: one word.
  void record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, Size blocks,
              const Scratch& scratch, const Buffer& number) const {
    const int count = blocks.width * blocks.height;
    if (count == 0) return recorder.fill(number, source_.of_no_block);
    recorder.fill(scratch.bins_, 0);
    recorder.dispatch(count_, CountBlocksPush{left.plane, right.plane, blocks.width, blocks.height},
                      {reads(left), reads(right), writes(scratch.bins_)}, {(count + kMeasureGroup - 1) / kMeasureGroup, 2});
    recorder.dispatch(number_, QuantilePush{source_.share}, {reads(scratch.bins_), writes(number)}, {1, 1});
  }

 private:
  Source source_;
  Kernel count_, number_;
};

}  // namespace duo::vk
