#include "stages/mark_targets/mark_targets_vk.h"

#include <cstring>

#include "stages/mark_targets/mark_targets_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMarkTargetsCode[] = {
#include "spirv/mark_targets.comp.inc"
};
static_assert(kMarkTargets == kMaxTargets && kMarkBins == kColorBins);

MarkTarget words_of(const Target& target) {
  const auto& [color, gate, window] = target;
  return {color.hue,
          color.hue_tolerance,
          color.min_saturation,
          color.min_value,
          color.likelihood,
          color.min_likelihood,
          gate.min_q4,
          gate.max_q4,
          gate.background_tolerance_q4,
          gate.pass_unknown,
          window.x,
          window.y,
          window.x_end(),
          window.y_end()};
}

}  // namespace

Result<MarkTargets> MarkTargets::make(const Device& device) {
  MarkTargets out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"mark targets", kMarkTargetsCode, 7, sizeof(MarkTargetsPush)}));
  return out;
}

void MarkTargets::record(Recorder& recorder, const Input& in, BufferView<std::uint8_t> marks, Size size) const {
  DUO_CHECK(in.hue.holds(size) && in.saturation.holds(size) && in.value.holds(size) && marks.holds(size));
  DUO_CHECK((in.d_q4.absent() || in.d_q4.holds(size)) && (in.background_q4.absent() || in.background_q4.holds(size)));
  DUO_CHECK(in.wanted != nullptr && in.wanted->bytes() >= wanted_bytes(1));  // 1: a kernel's array is never empty
  const MarkTargetsPush push{in.hue.plane, in.saturation.plane, in.value.plane, in.d_q4.plane,     in.background_q4.plane,
                             marks.plane,  size.width,          size.height,    !in.d_q4.absent(), !in.background_q4.absent()};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(in.hue) : reads(view); };
  recorder.dispatch(kernel_, push,
                    {reads(*in.wanted), reads(in.hue), reads(in.saturation), reads(in.value), present(in.d_q4),
                     present(in.background_q4), writes(marks)},
                    groups_for(size));
}

std::size_t MarkTargets::wanted_bytes(std::size_t tables) {
  return sizeof(MarkTarget) * kMarkTargets + sizeof(ColorLikelihood) * tables;
}

void MarkTargets::write(std::span<const Target> targets, std::span<const ColorLikelihood> likelihoods,
                        std::span<std::byte> wanted) {
  DUO_CHECK(targets.size() <= kMaxTargets && wanted.size() >= wanted_bytes(likelihoods.size()));
  MarkTarget words[kMarkTargets] = {};
  for (std::size_t t = 0; t < targets.size(); ++t) {
    DUO_CHECK(targets[t].color.likelihood < static_cast<int>(likelihoods.size()));
    words[t] = words_of(targets[t]);
  }
  std::memcpy(wanted.data(), words, sizeof words);
  if (!likelihoods.empty()) std::memcpy(wanted.data() + sizeof words, likelihoods.data(), likelihoods.size_bytes());
}

}  // namespace duo::vk
