#include "stages/mark_targets/mark_targets_vk.h"

#include <cstring>

#include "stages/mark_targets/mark_targets_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMarkTargetsCode[] = {
#include "spirv/mark_targets.comp.inc"
};
static_assert(kMarkTargets == kMaxTargets);

MarkTarget words_of(const Target& target) {
  const auto& [color, window] = target;
  return {color.hue, color.hue_tolerance, color.min_saturation, color.min_value, window.x,
          window.y,  window.x_end(),      window.y_end()};
}

}  // namespace

Result<MarkTargets> MarkTargets::make(const Device& device) {
  MarkTargets out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"mark targets", kMarkTargetsCode, 5, sizeof(MarkTargetsPush)}));
  return out;
}

void MarkTargets::record(Recorder& recorder, const Input& in, BufferView<std::uint8_t> marks, Size size) const {
  DUO_CHECK(in.hue.holds(size) && in.saturation.holds(size) && in.value.holds(size) && marks.holds(size));
  DUO_CHECK(in.targets != nullptr && in.targets->bytes() >= target_bytes());
  const MarkTargetsPush push{in.hue.plane, in.saturation.plane, in.value.plane, marks.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(*in.targets), reads(in.hue), reads(in.saturation), reads(in.value), writes(marks)},
                    groups_for(size));
}

std::size_t MarkTargets::target_bytes() { return sizeof(MarkTarget) * kMarkTargets; }

void MarkTargets::write(std::span<const Target> targets, std::span<std::byte> to) {
  DUO_CHECK(targets.size() <= kMaxTargets && to.size() >= target_bytes());
  MarkTarget words[kMarkTargets] = {};
  for (std::size_t t = 0; t < targets.size(); ++t) words[t] = words_of(targets[t]);
  std::memcpy(to.data(), words, sizeof words);
}

}  // namespace duo::vk
