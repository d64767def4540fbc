// What the Vulkan engine does with a pair: pictures up, denoise, rectify, match, fill, depth, wanted maps down. Recorded once.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "engines/filling.h"
#include "engines/prepared.h"
#include "matchers/matchers_vk.h"
#include "stages/depth/depth_vk.h"
#include "stages/fill/fill_vk.h"
#include "stages/gaussian/gaussian_vk.h"
#include "stages/gray/gray_vk.h"
#include "stages/median/median_vk.h"
#include "stages/rectify/rectify_vk.h"
#include "vulkan/frame_on_device.h"
#include "vulkan/timer.h"

namespace duo::vk {

/// Kernels, memory and recordings for the pairs of one setup. The recordings of the slots use the same maps, one after the
/// other; what the CPU writes and reads is each slot's own, and so are the maps that stay on the device.
///
/// Threads  one at a time; besides, one that uses the frames on the device
class Frames {
 public:
  static constexpr int kInFlight = 2;
  static constexpr int kSlots =
      kInFlight + 2;  // where maps stay on the device: those of two frames while the next ones are made

  /// Errors  the device lacks memory, or the driver refuses a kernel
  static Result<std::unique_ptr<Frames>> make(const std::shared_ptr<Device>& device, const Prepared& prepared);
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;

  int slots() const { return static_cast<int>(slots_.size()); }
  /// Starts work on a pair; its slot must have been collected.
  ///
  /// Errors  those of Recorder::submit()
  Result<void> submit(int slot, const Pair& pair);
  /// Waits for it and takes the maps that the frame has memory for.
  ///
  /// Errors  those of Device::wait(): what the frame holds then means nothing
  Result<void> collect(int slot, Frame& frame);
  /// Whose maps stay as they are from a slot's collect() to its next submit(); null where that was not wanted.
  const std::shared_ptr<FrameMaps>& on_device() const { return on_device_; }
  /// A frame with memory for what is wanted, and with what is the same in all of them.
  Frame make_frame() const;

 private:
  /// One camera's pictures on their way to what the matcher sees.
  struct ViewMaps {
    Buffer raw, gray, denoised, inside, corner, fraction_q8;
    ResampleMap::Columns columns = ResampleMap::Columns::kLinear;
  };
  struct Slot {
    std::array<Buffer, 2> raw;
    Buffer coding_noise_q4;  // one word
    struct {
      Buffer left, right, d_q4, origin, confidence, depth_mm, color;  // empty where not wanted
    } down;
    Timer timer;
    std::optional<Recorder> recorder;  // after all that its work uses: it waits for it
    Ticket ticket = 0;
  };

  Frames(Device& device, const Prepared& prepared) : device_(device), prepared_(prepared) {}
  Result<void> make_kernels();
  Result<void> make_maps();
  Result<void> make_view(ViewMaps& view, const char* name, const ResampleMap* map);
  Result<void> make_slot(Slot& slot);
  Result<void> record(Slot& slot);
  /// Where the maps of a slot's frame go.
  const FrameMaps::Slot& maps_of(const Slot& slot) const;
  std::array<BufferView<std::uint8_t>, 2> record_views(Slot& slot);
  void record_match(Slot& slot, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right,
                    BufferView<std::uint16_t> d_q4) const;
  void record_depth(Slot& slot, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right);
  void record_downloads(Slot& slot, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right);
  Rectify::Map map_of(const ViewMaps& view) const;
  void fill(Frame& frame);
  /// Who would look at frames on the device looks at filled ones on the CPU, and in colour.
  bool sends_color() const {
    const Setup& setup = prepared_.setup;
    return setup.wants.color || (setup.wants.on_device && setup.fill);
  }
  bool rectifies() const { return prepared_.rectification.has_value(); }

  Device& device_;
  const Prepared& prepared_;
  Gray gray_;
  Median median_;
  Gaussian gaussian_;
  Rectify rectify_;
  VulkanMatcher matcher_;
  Fill fill_;
  std::optional<Depth> depth_;
  std::array<ViewMaps, 2> views_;
  Buffer right_;  // rectified
  Buffer origin_, confidence_, depth_mm_;
  FrameMaps::Slot maps_;  // of all slots, where the maps do not stay
  std::shared_ptr<FrameMaps> on_device_;
  std::vector<Slot> slots_;
  Pool pool_{1};  // whose frames are collected: it has nothing else to do
  std::optional<Filling> filling_;
};

}  // namespace duo::vk
