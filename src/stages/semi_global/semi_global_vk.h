#pragma once

#include "stages/semi_global/semi_global.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Semi-global matching on a device; the contract is in semi_global.h.
///
/// A byte for each pixel and disparity of the costs and of each direction along which paths go down or from the left, all at
/// the same time; paths from below are added to those from above, and those from the right are summed up as they are walked.
class SemiGlobal {
 public:
  /// SemiGlobalMatch on the device; margin may be absent = not wanted.
  struct Match {
    BufferView<std::int16_t> left, right;
    BufferView<std::uint16_t> fine;
    BufferView<std::uint8_t> margin = {};
  };
  /// The volumes; one for each recording that may run at the same time as another.
  class Scratch {
   public:
    /// Errors  more pixels times disparities than a buffer holds, out of memory
    static Result<Scratch> make(const Device& device, Size size, int max_disparity, const SemiGlobalParams& params);

   private:
    friend SemiGlobal;
    Size size_;
    int words_ = 0;  // of a pixel in a volume
    Buffer costs_, found_;
    std::vector<Buffer> volumes_;
  };
  /// max_disparity 1 .. 256.
  static Result<SemiGlobal> make(const Device& device, int max_disparity, const SemiGlobalParams& params);
  /// `left` and `right` hold planes as vk::MatchPlanes packs them. `even_unless_clear`: a word; where it is not above 0 P2 is
  /// the same at all steps of gray, p2_least = p2. None: P2 as the parameters say.
  void record(Recorder& recorder, BufferView<std::uint32_t> left, BufferView<std::uint32_t> right, const Scratch& scratch,
              const Match& out, Size size, const Buffer* even_unless_clear = nullptr) const;

 private:
  void record_path(Recorder& recorder, BufferView<std::uint32_t> left, const Scratch& scratch, int dx, int dy,
                   const Buffer& volume, bool adds) const;
  void record_winners(Recorder& recorder, BufferView<std::uint32_t> left, const Scratch& scratch, const Match& out) const;
  /// Workgroups for so many paths.
  Size groups_for_paths(int paths) const;

  SemiGlobalParams params_;
  int max_disparity_ = 0;
  int paths_per_group_ = 0;
  Kernel costs_, path_, winners_, fine_;
};

}  // namespace duo::vk
