#include "stages/match_tiles/match_tiles_vk.h"

#include "stages/match_tiles/match_tiles_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kChannelsCode[] = {
#include "spirv/match_tiles_channels.comp.inc"
};
constexpr std::uint32_t kMatchTilesCode[] = {
#include "spirv/match_tiles.comp.inc"
};
constexpr std::uint32_t kRightCode[] = {
#include "spirv/match_tiles_right.comp.inc"
};

static_assert(kTilePixelsX == TileSets::kWidth && kTilePixelsY == TileSets::kHeight);

}  // namespace

Result<MatchTiles::Scratch> MatchTiles::Scratch::make(const Device& device, Size size) {
  const std::size_t pixels = static_cast<std::size_t>(size.width) * size.height, word = sizeof(std::uint32_t);
  Scratch out;
  out.size_ = size;
  DUO_TRY_ASSIGN(out.left_, Buffer::make(device, "match tiles left channels", pixels * word, Memory::kDevice));
  DUO_TRY_ASSIGN(out.right_, Buffer::make(device, "match tiles right channels", pixels * word * 2, Memory::kDevice));
  DUO_TRY_ASSIGN(out.right_best_, Buffer::make(device, "match tiles right costs", pixels * word, Memory::kDevice));
  return out;
}

Result<MatchTiles> MatchTiles::make(const Device& device) {
  MatchTiles out;
  DUO_TRY_ASSIGN(out.channels_, Kernel::make(device, {"match tiles channels", kChannelsCode, 3, sizeof(MatchChannelsPush)}));
  DUO_TRY_ASSIGN(out.match_, Kernel::make(device, {"match tiles", kMatchTilesCode, 6, sizeof(MatchTilesPush)}));
  DUO_TRY_ASSIGN(out.right_, Kernel::make(device, {"match tiles right", kRightCode, 2, sizeof(MatchRightPush)}));
  return out;
}

void MatchTiles::record_channels(Recorder& recorder, const Input& in, const MatchTilesParams& params,
                                 const Scratch& scratch) const {
  DUO_CHECK(params.sobel_clip >= 1 && params.sobel_clip <= 63);
  DUO_CHECK(in.left_inside.absent() == in.right_inside.absent());
  recorder.fill(scratch.right_best_, 0xFFFFFFFF);
  record_channels_of(recorder, in.left, in.left_inside, params.sobel_clip, false, scratch.left_, scratch.size_);
  record_channels_of(recorder, in.right, in.right_inside, params.sobel_clip, true, scratch.right_, scratch.size_);
}

void MatchTiles::record_channels_of(Recorder& recorder, BufferView<std::uint8_t> picture, BufferView<std::uint8_t> inside,
                                    int clip, bool right, const Buffer& words, Size size) const {
  const bool masked = !inside.absent();
  DUO_CHECK(picture.holds(size) && (!masked || inside.holds(size)));
  const MatchChannelsPush push{picture.plane, inside.plane, size.width, size.height, clip, right, masked};
  // Every binding needs a buffer; the kernel does not look at the one that stands in for an absent picture.
  recorder.dispatch(channels_, push, {reads(picture), masked ? reads(inside) : reads(picture), writes(words)},
                    groups_for(size));
}

void MatchTiles::record(Recorder& recorder, const Input& in, const MatchTilesParams& params, const Scratch& scratch,
                        const Output& out) const {
  const Size size = scratch.size_;
  const bool all = in.sets.absent();
  DUO_CHECK(params.truncation >= 1 && params.truncation <= 12);
  DUO_CHECK(all || in.sets.holds(TileSets::shape32(size, in.max_disparity)));
  DUO_CHECK(out.left.holds(size) && out.right.holds(size) && out.fine.holds(size));
  const MatchTilesPush push{in.sets.plane,
                            out.left.plane,
                            out.fine.plane,
                            size.width,
                            size.height,
                            in.max_disparity,
                            params.truncation,
                            params.wide_shifts ? 3 : 2,
                            all};
  recorder.dispatch(match_, push,
                    {reads(scratch.left_), reads(scratch.right_), all ? reads(scratch.left_) : reads(in.sets),
                     writes(scratch.right_best_), writes(out.left), writes(out.fine)},
                    TileSets::tiles_of(size));
  recorder.dispatch(right_, MatchRightPush{out.right.plane, size.width, size.height},
                    {reads(scratch.right_best_), writes(out.right)}, groups_for(size));
}

}  // namespace duo::vk
