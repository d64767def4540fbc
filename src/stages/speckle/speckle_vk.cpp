#include "stages/speckle/speckle_vk.h"

#include "stages/speckle/speckle_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kRunsCode[] = {
#include "spirv/speckle_runs.comp.inc"
};
constexpr std::uint32_t kJoinCode[] = {
#include "spirv/speckle_join.comp.inc"
};
constexpr std::uint32_t kCountCode[] = {
#include "spirv/speckle_count.comp.inc"
};
constexpr std::uint32_t kSpeckleCode[] = {
#include "spirv/speckle.comp.inc"
};

}  // namespace

Result<RemoveSpeckle::Scratch> RemoveSpeckle::Scratch::make(const Device& device, Size size) {
  DUO_CHECK(!size.empty());
  Scratch out;
  out.size_ = size;
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  DUO_TRY_ASSIGN(out.labels_, Buffer::make(device, "speckle labels", pixels * sizeof(std::uint32_t), Memory::kDevice));
  DUO_TRY_ASSIGN(out.pixels_, Buffer::make(device, "speckle pixels", pixels * sizeof(std::uint32_t), Memory::kDevice));
  return out;
}

Result<RemoveSpeckle> RemoveSpeckle::make(const Device& device) {
  RemoveSpeckle out;
  DUO_TRY_ASSIGN(out.runs_, Kernel::make(device, {"speckle runs", kRunsCode, 3, sizeof(SpecklePush)}));
  DUO_TRY_ASSIGN(out.join_, Kernel::make(device, {"speckle join", kJoinCode, 3, sizeof(SpecklePush)}));
  DUO_TRY_ASSIGN(out.count_, Kernel::make(device, {"speckle count", kCountCode, 3, sizeof(SpecklePush)}));
  DUO_TRY_ASSIGN(out.remove_, Kernel::make(device, {"speckle", kSpeckleCode, 3, sizeof(SpecklePush)}));
  return out;
}

void RemoveSpeckle::record(Recorder& recorder, BufferView<std::uint16_t> d_q4, int step_q4, int smallest,
                           const Scratch& scratch, Size size) const {
  DUO_CHECK(d_q4.holds(size) && scratch.size_ == size);
  const SpecklePush push{d_q4.plane, size.width, size.height, step_q4, smallest};
  const Use labels = writes(scratch.labels_), pixels = writes(scratch.pixels_);
  recorder.dispatch(runs_, push, {reads(d_q4), labels, pixels}, {(size.width + kSpeckleRun - 1) / kSpeckleRun, size.height});
  recorder.dispatch(join_, push, {reads(d_q4), labels, pixels}, groups_for(size));
  recorder.dispatch(count_, push, {reads(d_q4), labels, pixels}, groups_for(size));
  recorder.dispatch(remove_, push, {writes(d_q4), labels, pixels}, groups_for(size));
}

}  // namespace duo::vk
