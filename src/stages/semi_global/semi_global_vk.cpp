#include "stages/semi_global/semi_global_vk.h"

#include <fmt/format.h>

#include <bit>

#include "stages/semi_global/semi_global_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kCostsCode[] = {
#include "spirv/semi_global_costs.comp.inc"
};
constexpr std::uint32_t kPathCode[] = {
#include "spirv/semi_global_path.comp.inc"
};
constexpr std::uint32_t kSemiGlobalCode[] = {
#include "spirv/semi_global.comp.inc"
};
constexpr std::uint32_t kFineCode[] = {
#include "spirv/semi_global_fine.comp.inc"
};

/// Words of a pixel in a volume.
int words_for(int max_disparity) { return (max_disparity + 3) / 4; }

/// From the left and from above, and with diagonals two more.
int volumes_for(const SemiGlobalParams& params) { return params.diagonals ? kMostVolumes : 2; }

}  // namespace

Result<SemiGlobal::Scratch> SemiGlobal::Scratch::make(const Device& device, Size size, int max_disparity,
                                                      const SemiGlobalParams& params) {
  DUO_CHECK(!size.empty() && max_disparity >= 1 && max_disparity <= 256);
  Scratch out;
  out.size_ = size;
  out.words_ = words_for(max_disparity);
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  const std::size_t bytes = pixels * static_cast<std::size_t>(out.words_) * sizeof(std::uint32_t);
  const std::size_t with_penalty = bytes + sizeof(std::uint32_t);
  if (with_penalty > Buffer::kMaxBytes)
    return Error{
        ErrorCode::kBadInput,
        fmt::format("set up semi-global matching on {}: {}x{} pixels with {} disparities take {} MiB a direction, more "
                    "than the {} MiB of a buffer; choose at most {} disparities, or smaller pictures",
                    device.info().name, size.width, size.height, max_disparity, bytes >> 20, Buffer::kMaxBytes >> 20,
                    Buffer::kMaxBytes / pixels / 4 * 4)};
  DUO_TRY_ASSIGN(out.costs_, Buffer::make(device, "semi-global costs", with_penalty, Memory::kDevice));
  DUO_TRY_ASSIGN(out.found_, Buffer::make(device, "semi-global winners", pixels * sizeof(std::uint32_t), Memory::kDevice));
  for (int i = 0; i < volumes_for(params); ++i) {
    DUO_TRY_ASSIGN(Buffer volume, Buffer::make(device, fmt::format("semi-global paths {}", i), bytes, Memory::kDevice));
    out.volumes_.push_back(std::move(volume));
  }
  return out;
}

Result<SemiGlobal> SemiGlobal::make(const Device& device, int max_disparity, const SemiGlobalParams& params) {
  DUO_CHECK(max_disparity >= 1 && max_disparity <= 256);
  SemiGlobal out;
  out.params_ = params;
  out.max_disparity_ = max_disparity;
  // A word a lane where subgroups can be as large; larger ones would have lanes without work.
  const int words = words_for(max_disparity), lanes = device.subgroup_size_near(std::min(std::bit_ceil(unsigned(words)), 32U));
  out.paths_per_group_ = std::max(1, kPathGroup / lanes);
  const auto lane_words = static_cast<std::uint32_t>((words + lanes - 1) / lanes);
  const std::uint32_t constants[] = {lane_words, static_cast<std::uint32_t>(volumes_for(params))};
  const std::span path_constants(constants, 1);
  DUO_TRY_ASSIGN(out.costs_, Kernel::make(device, {"semi-global costs", kCostsCode, 4, sizeof(SemiGlobalCostsPush)}));
  DUO_TRY_ASSIGN(out.path_,
                 Kernel::make(device, {"semi-global path", kPathCode, 3, sizeof(SemiGlobalPathPush), path_constants, lanes}));
  DUO_TRY_ASSIGN(out.winners_,
                 Kernel::make(device, {"semi-global winners", kSemiGlobalCode, 8, sizeof(SemiGlobalPush), constants, lanes}));
  DUO_TRY_ASSIGN(out.fine_, Kernel::make(device, {"semi-global fine", kFineCode, 4, sizeof(SemiGlobalFinePush)}));
  return out;
}

void SemiGlobal::record(Recorder& recorder, BufferView<std::uint32_t> left, BufferView<std::uint32_t> right,
                        const Scratch& scratch, const Match& out, Size size, const Buffer* even_unless_clear) const {
  const Size planes{size.width, kPackedPlanes * size.height};
  DUO_CHECK(left.holds(planes) && right.holds(planes) && out.left.holds(size) && out.right.holds(size) && out.fine.holds(size));
  DUO_CHECK(out.margin.absent() || out.margin.holds(size));
  DUO_CHECK(scratch.size_ == size && scratch.words_ == words_for(max_disparity_) &&
            static_cast<int>(scratch.volumes_.size()) == volumes_for(params_));
  const int runs = (size.width + kCostRun - 1) / kCostRun, invocations = runs * scratch.words_;
  const SemiGlobalCostsPush costs{left.plane,
                                  right.plane,
                                  size.width,
                                  size.height,
                                  max_disparity_,
                                  scratch.words_,
                                  params_.census_truncation,
                                  params_.truncation,
                                  params_.p2_least,
                                  even_unless_clear != nullptr ? params_.p2 : params_.p2_least};
  // Every binding needs a buffer; one that is not looked at stands in.
  recorder.dispatch(costs_, costs,
                    {reads(left), reads(right), writes(scratch.costs_),
                     even_unless_clear != nullptr ? reads(*even_unless_clear) : reads(left)},
                    {(invocations + kCostGroup - 1) / kCostGroup, size.height});

  // The directions of one pass share no volume, so that no barrier keeps them from running at the same time.
  const std::vector<Buffer>& volumes = scratch.volumes_;
  record_path(recorder, left, scratch, 1, 0, volumes[0], false);
  for (const int dy : {1, -1}) {
    if (dy < 0 && !params_.upward) continue;
    record_path(recorder, left, scratch, 0, dy, volumes[1], dy < 0);
    if (!params_.diagonals) continue;
    record_path(recorder, left, scratch, 1, dy, volumes[2], dy < 0);
    record_path(recorder, left, scratch, -1, dy, volumes[3], dy < 0);
  }
  record_winners(recorder, left, scratch, out);
}

Size SemiGlobal::groups_for_paths(int paths) const { return {(paths + paths_per_group_ - 1) / paths_per_group_, 1}; }

void SemiGlobal::record_path(Recorder& recorder, BufferView<std::uint32_t> left, const Scratch& scratch, int dx, int dy,
                             const Buffer& volume, bool adds) const {
  const Size size = scratch.size_;
  const SemiGlobalPathPush push{
      left.plane, size.width, size.height, scratch.words_, params_.p1, params_.p2, params_.p2_gradient, dx, dy, adds};
  recorder.dispatch(path_, push, {reads(scratch.costs_), reads(left), writes(volume)},
                    groups_for_paths(dy == 0 ? size.height : size.width));
}

void SemiGlobal::record_winners(Recorder& recorder, BufferView<std::uint32_t> left, const Scratch& scratch,
                                const Match& out) const {
  const Size size = scratch.size_;
  const bool wants_margin = !out.margin.absent();
  const SemiGlobalPush push{left.plane, out.right.plane, size.width,          size.height, scratch.words_,
                            params_.p1, params_.p2,      params_.p2_gradient, wants_margin};
  const auto volume = [&](std::size_t i) { return reads(scratch.volumes_[std::min(i, scratch.volumes_.size() - 1)]); };
  recorder.dispatch(winners_, push,
                    {reads(scratch.costs_), reads(left), volume(0), volume(1), volume(2), volume(3), writes(scratch.found_),
                     writes(out.right)},
                    groups_for_paths(size.height));
  const SemiGlobalFinePush fine{out.left.plane, out.fine.plane, out.margin.plane, size.width,
                                size.height,    max_disparity_, wants_margin};
  // Every binding needs a buffer; the kernel does not look at the one that stands in for an absent margin.
  recorder.dispatch(
      fine_, fine,
      {reads(scratch.found_), writes(out.left), writes(out.fine), wants_margin ? writes(out.margin) : writes(out.fine)},
      groups_for(size));
}

}  // namespace duo::vk
