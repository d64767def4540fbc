#pragma once

#include "stages/sift/sift.h"
#include "stages/types/sift_list.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// SIFT in several windows on a device; the contract is in sift.h.
///
/// Exact    blurs and differences have the reference's bits; where the reference computes in doubles, pairs of floats do here.
/// So
///          points and descriptors are nearly always the same, and never further apart than a few last bits unless a threshold
///          lies between
/// Errors   as in sift.h; besides, extrema beyond four times the capacity are dropped, last first, and count as overflow
class Sift {
 public:
  /// Planes and lists of up to `windows` windows at once, none larger than `largest_window`.
  class Scratch {
   public:
    /// Errors  planes of more than a buffer may have: fewer or smaller windows
    static Result<Scratch> make(const Device& device, Size largest_window, int windows, int capacity,
                                const SiftParams& params = {});
    /// Of the lists of points that it is made for, one a window.
    SiftListShape list_shape() const { return {windows_, capacity_}; }

   private:
    friend class Sift;
    Size room_;
    int windows_ = 0, capacity_ = 0;
    SiftParams params_;
    Buffer planes_, claims_, work_, groups_;
  };
  static Result<Sift> make(const Device& device);
  /// windows: a Window for each list, read anew each time the recording runs; empty ones and those that are too large give no
  /// points points: lists of scratch.list_shape()
  void record(Recorder& recorder, BufferView<std::uint8_t> src, const Buffer& windows, const Scratch& scratch,
              const Buffer& points, Size size) const;

 private:
  Kernel blur_, mark_, lists_, refine_, orient_, describe_;
};

}  // namespace duo::vk
