#include "matchers/sgm/sgm_vk.h"

#include "matchers/sgm/keep_confidence_params.h"
#include "matchers/sgm/settle_clear_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kKeepConfidenceCode[] = {
#include "spirv/keep_confidence.comp.inc"
};

constexpr std::uint32_t kSettleClearCode[] = {
#include "spirv/settle_clear.comp.inc"
};

template <class T>
Result<Buffer> make_map(const Device& device, const std::string& name, Size size) {
  return Buffer::make(device, "sgm " + name,
                      sizeof(T) * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height),
                      Memory::kDevice);
}

}  // namespace

Result<Sgm> Sgm::make(Device& device, const SgmParams& params, const MatchSetup& setup) {
  Sgm out;
  out.params_ = params;
  out.setup_ = setup;
  DUO_TRY_ASSIGN(out.maps_, make_maps(device, params, setup));
  DUO_TRY_ASSIGN(out.balance_, Balance::make(device));
  DUO_TRY_ASSIGN(out.noise_, Noise::make(device));
  DUO_TRY_ASSIGN(out.blur_, Blur::make(device));
  DUO_TRY_ASSIGN(out.bilateral_, Bilateral::make(device));
  DUO_TRY_ASSIGN(out.match_planes_, MatchPlanes::make(device));
  DUO_TRY_ASSIGN(out.semi_global_, SemiGlobal::make(device, setup.max_disparity, params.semi_global(false)));
  DUO_TRY_ASSIGN(out.check_left_right_, CheckLeftRight::make(device));
  DUO_TRY_ASSIGN(out.remove_speckle_, RemoveSpeckle::make(device));
  DUO_TRY_ASSIGN(out.weighted_median_, WeightedMedian::make(device));
  DUO_TRY_ASSIGN(out.lucas_kanade_, LucasKanade::make(device));
  DUO_TRY_ASSIGN(out.keep_confidence_,
                 Kernel::make(device, {"keep confidence", kKeepConfidenceCode, 2, sizeof(KeepConfidencePush)}));
  DUO_TRY_ASSIGN(out.settle_clear_, Kernel::make(device, {"settle clear", kSettleClearCode, 4, sizeof(SettleClearPush)}));
  return out;
}

Result<Sgm::Maps> Sgm::make_maps(Device& device, const SgmParams& params, const MatchSetup& setup) {
  const Size size = setup.size, planes = MatchPlanes::packed_size(size);
  Maps out;
  // First what may be too large.
  DUO_TRY_ASSIGN(out.semi_global, SemiGlobal::Scratch::make(device, size, setup.max_disparity, params.semi_global(false)));
  DUO_TRY_ASSIGN(out.balance, Balance::Scratch::make(device, size));
  DUO_TRY_ASSIGN(out.noise, Noise::make_scratch(device));
  DUO_TRY_ASSIGN(out.blur, Blur::make_scratch(device));
  DUO_TRY_ASSIGN(out.speckle, RemoveSpeckle::Scratch::make(device, size));
  DUO_TRY_ASSIGN(out.balanced, make_map<std::uint8_t>(device, "balanced", size));
  DUO_TRY_ASSIGN(out.noise_q4, Buffer::make(device, "sgm noise", sizeof(std::uint32_t), Memory::kDevice));
  DUO_TRY_ASSIGN(out.blur_q4, Buffer::make(device, "sgm blur", sizeof(std::uint32_t), Memory::kDevice));
  const std::int32_t before_the_first = 0, no_noise = 0;
  DUO_TRY_ASSIGN(out.not_coded, make_filled(device, "sgm not coded", std::as_bytes(std::span(&no_noise, 1))));
  DUO_TRY_ASSIGN(out.stream, make_filled(device, "sgm stream", std::as_bytes(std::span(&before_the_first, 1))));
  DUO_TRY_ASSIGN(out.soft_left, make_map<std::uint8_t>(device, "soft left", size));
  DUO_TRY_ASSIGN(out.soft_right, make_map<std::uint8_t>(device, "soft right", size));
  DUO_TRY_ASSIGN(out.left_planes, make_map<std::uint32_t>(device, "left planes", planes));
  DUO_TRY_ASSIGN(out.right_planes, make_map<std::uint32_t>(device, "right planes", planes));
  DUO_TRY_ASSIGN(out.left_winner, make_map<std::int16_t>(device, "left winner", size));
  DUO_TRY_ASSIGN(out.right_winner, make_map<std::int16_t>(device, "right winner", size));
  DUO_TRY_ASSIGN(out.fine, make_map<std::uint16_t>(device, "fine", size));
  DUO_TRY_ASSIGN(out.checked, make_map<std::uint16_t>(device, "checked", size));
  return out;
}

void Sgm::record(Recorder& recorder, const Input& pair, const Output& out) const {
  DUO_CHECK(setup_.masked != pair.left_inside.absent());
  const Size size = setup_.size;
  record_winners(recorder, pair, out.confidence);
  // What follows the check writes to another image than it reads: the check starts in the one from which it ends in d_q4.
  const bool refine = refines(params_, setup_.masked);
  const auto between = whole<std::uint16_t>(maps_.checked);
  const auto smoothed = refine ? between : out.d_q4, before = refine ? out.d_q4 : between;
  const auto checked = params_.smooth != 0 ? before : smoothed;
  check_left_right_.record(recorder,
                           {whole<std::int16_t>(maps_.left_winner), whole<std::int16_t>(maps_.right_winner), pair.left_inside,
                            pair.right_inside, params_.tolerance, params_.reach},
                           whole<std::uint16_t>(maps_.fine), checked, size);
  recorder.stage("check_left_right");
  remove_speckle_.record(recorder, checked, params_.speckle_step_q4, params_.speckle, maps_.speckle, size);
  recorder.stage("speckle");
  if (params_.smooth != 0) weighted_median_.record(recorder, {checked, left_of(pair)}, smoothed, size);
  recorder.stage("weighted_median");
  if (refine)
    lucas_kanade_.record(recorder, {left_of(pair), right_as_matched(), smoothed, setup_.max_disparity}, maps_.stream, out.d_q4,
                         size);
  recorder.stage("lucas_kanade");
  if (!out.confidence.absent())
    recorder.dispatch(keep_confidence_, KeepConfidencePush{out.d_q4.plane, out.confidence.plane, size.width, size.height},
                      {reads(out.d_q4), writes(out.confidence)}, groups_for(size));
  recorder.stage("keep_confidence");
}

void Sgm::record_winners(Recorder& recorder, const Input& pair, BufferView<std::uint8_t> margin) const {
  const Size size = setup_.size;
  const auto balanced = whole<std::uint8_t>(maps_.balanced);
  const auto left = whole<std::uint32_t>(maps_.left_planes), right = whole<std::uint32_t>(maps_.right_planes);
  noise_.record(recorder, pair.left, pair.right, maps_.noise, maps_.noise_q4, size);
  recorder.stage("noise");
  blur_.record(recorder, pair.left, pair.right, maps_.blur, maps_.blur_q4, size);
  const Buffer& coding_noise_q4 = pair.coding_noise_q4 != nullptr ? *pair.coding_noise_q4 : maps_.not_coded;
  recorder.dispatch(settle_clear_, SettleClearPush{params_.soften, params_.clear},
                    {writes(maps_.noise_q4), reads(maps_.blur_q4), reads(coding_noise_q4), writes(maps_.stream)}, {1, 1});
  recorder.stage("blur");
  balance_.record(recorder, {pair.left, pair.right, pair.left_inside, pair.right_inside}, setup_.max_disparity, &maps_.stream,
                  maps_.balance, balanced, size);
  recorder.stage("balance");
  if (params_.soften != 0) {
    bilateral_.record(recorder, pair.left, maps_.noise_q4, left_of(pair), size);
    bilateral_.record(recorder, balanced, maps_.noise_q4, right_as_matched(), size);
  }
  recorder.stage("bilateral");
  match_planes_.record(recorder, left_of(pair), pair.left_inside, maps_.noise_q4, maps_.stream, left, size);
  match_planes_.record(recorder, right_as_matched(), pair.right_inside, maps_.noise_q4, maps_.stream, right, size);
  recorder.stage("match_planes");
  semi_global_.record(recorder, left, right, maps_.semi_global,
                      {whole<std::int16_t>(maps_.left_winner), whole<std::int16_t>(maps_.right_winner),
                       whole<std::uint16_t>(maps_.fine), margin},
                      size, is_even(params_, setup_.denoised) ? &maps_.stream : nullptr);
  recorder.stage("semi_global");
}

}  // namespace duo::vk
