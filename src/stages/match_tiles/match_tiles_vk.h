#pragma once

#include "stages/match_tiles/match_tiles.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Window matching in tiles on a device; the contract is in match_tiles.h.
class MatchTiles {
 public:
  /// GrayPair and candidates on the device. Inside pictures may be absent, both or none; without sets, every tile tries
  /// everything.
  struct Input {
    BufferView<std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
    BufferView<std::uint32_t> sets = {};  // as TileSets::shape32() says
    int max_disparity = 0;
  };
  /// TileMatch on the device.
  struct Output {
    BufferView<std::int16_t> left = {}, right = {};
    BufferView<std::uint16_t> fine = {};
  };
  /// Both pictures' channels, and the right view's least costs.
  class Scratch {
   public:
    static Result<Scratch> make(const Device& device, Size size);

   private:
    friend MatchTiles;
    Size size_;
    Buffer left_, right_, right_best_;
  };
  static Result<MatchTiles> make(const Device& device);
  /// What depends on the pictures only: candidates may still be in the making.
  void record_channels(Recorder& recorder, const Input& in, const MatchTilesParams& params, const Scratch& scratch) const;
  /// The rest; `in` and `scratch` as before.
  void record(Recorder& recorder, const Input& in, const MatchTilesParams& params, const Scratch& scratch,
              const Output& out) const;

 private:
  void record_channels_of(Recorder& recorder, BufferView<std::uint8_t> picture, BufferView<std::uint8_t> inside, int clip,
                          bool right, const Buffer& words, Size size) const;

  Kernel channels_, match_, right_;
};

}  // namespace duo::vk
