#include "matchers/sgm/sgm_vk.h"

#include "matchers/sgm/keep_confidence_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kKeepConfidenceCode[] = {
#include "spirv/keep_confidence.comp.inc"
};

template <class T>
Result<Buffer> make_map(const Device& device, const std::string& name, Size size) {
  return Buffer::make(device, "sgm " + name, sizeof(T) * size.width * size.height, Memory::kDevice);
}

template <class T>
BufferView<T> map_in(const Buffer& buffer, Size size) {
  return {buffer, {0, size.width}};
}

}  // namespace

Result<Sgm> Sgm::make(const Device& device, const SgmParams& params, const MatchSetup& setup) {
  Sgm out;
  out.params_ = params;
  out.size_ = setup.size;
  out.masked_ = setup.masked;
  // The volumes first: they are what may be too large.
  DUO_TRY_ASSIGN(out.volumes_, SemiGlobal::Scratch::make(device, setup.size, setup.max_disparity, params.semi_global()));
  DUO_TRY_ASSIGN(out.maps_, make_maps(device, setup.size));
  DUO_TRY_ASSIGN(out.balance_scratch_, Balance::Scratch::make(device, setup.size));
  DUO_TRY_ASSIGN(out.speckle_scratch_, RemoveSpeckle::Scratch::make(device, setup.size));
  DUO_TRY(out.make_stages(device, setup.max_disparity));
  return out;
}

Result<Sgm::Maps> Sgm::make_maps(const Device& device, Size size) {
  Maps out;
  const Size planes = MatchPlanes::packed_size(size);
  DUO_TRY_ASSIGN(out.balanced, make_map<std::uint8_t>(device, "balanced", size));
  DUO_TRY_ASSIGN(out.left_planes, make_map<std::uint32_t>(device, "left planes", planes));
  DUO_TRY_ASSIGN(out.right_planes, make_map<std::uint32_t>(device, "right planes", planes));
  DUO_TRY_ASSIGN(out.left_winner, make_map<std::int16_t>(device, "left winner", size));
  DUO_TRY_ASSIGN(out.right_winner, make_map<std::int16_t>(device, "right winner", size));
  DUO_TRY_ASSIGN(out.fine, make_map<std::uint16_t>(device, "fine", size));
  DUO_TRY_ASSIGN(out.checked, make_map<std::uint16_t>(device, "checked", size));
  return out;
}

Result<void> Sgm::make_stages(const Device& device, int max_disparity) {
  DUO_TRY_ASSIGN(balance_, Balance::make(device));
  DUO_TRY_ASSIGN(match_planes_, MatchPlanes::make(device));
  DUO_TRY_ASSIGN(semi_global_, SemiGlobal::make(device, max_disparity, params_.semi_global()));
  DUO_TRY_ASSIGN(check_, CheckLeftRight::make(device));
  DUO_TRY_ASSIGN(remove_speckle_, RemoveSpeckle::make(device));
  DUO_TRY_ASSIGN(weighted_median_, WeightedMedian::make(device));
  DUO_TRY_ASSIGN(keep_confidence_,
                 Kernel::make(device, {"keep confidence", kKeepConfidenceCode, 2, sizeof(KeepConfidencePush)}));
  return {};
}

void Sgm::record(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4,
                 BufferView<std::uint8_t> confidence) const {
  DUO_CHECK(masked_ != pair.left_inside.absent() && d_q4.holds(size_));
  record_found(recorder, pair, confidence);
  record_cleaned(recorder, pair, d_q4);
  if (!confidence.absent()) {
    const KeepConfidencePush push{d_q4.plane, confidence.plane, size_.width, size_.height};
    recorder.dispatch(keep_confidence_, push, {reads(d_q4), writes(confidence)}, groups_for(size_));
  }
  recorder.stage("weighted_median");
}

/// The winners of both views.
void Sgm::record_found(Recorder& recorder, const Input& pair, BufferView<std::uint8_t> margin) const {
  const auto balanced = map_in<std::uint8_t>(maps_.balanced, size_);
  balance_.record(recorder, {pair.left, pair.right, pair.left_inside, pair.right_inside}, balance_scratch_, balanced, size_);
  recorder.stage("balance");
  const auto left = map_in<std::uint32_t>(maps_.left_planes, size_), right = map_in<std::uint32_t>(maps_.right_planes, size_);
  match_planes_.record(recorder, pair.left, pair.left_inside, left, size_);
  match_planes_.record(recorder, balanced, pair.right_inside, right, size_);
  recorder.stage("match_planes");
  semi_global_.record(recorder, left, right, volumes_,
                      {map_in<std::int16_t>(maps_.left_winner, size_), map_in<std::int16_t>(maps_.right_winner, size_),
                       map_in<std::uint16_t>(maps_.fine, size_), margin},
                      size_);
  recorder.stage("semi_global");
}

/// What of the winners is kept, smoothed.
void Sgm::record_cleaned(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const {
  // The weighted median writes to another map than it reads: the check starts in the one from which it ends in d_q4.
  const bool smooth = params_.smooth != 0;
  const auto checked = smooth ? map_in<std::uint16_t>(maps_.checked, size_) : d_q4;
  check_.record(recorder,
                {map_in<std::int16_t>(maps_.left_winner, size_), map_in<std::int16_t>(maps_.right_winner, size_),
                 pair.left_inside, pair.right_inside, params_.tolerance, params_.reach},
                map_in<std::uint16_t>(maps_.fine, size_), checked, size_);
  recorder.stage("check_left_right");
  remove_speckle_.record(recorder, checked, params_.speckle_step_q4, params_.speckle, speckle_scratch_, size_);
  recorder.stage("speckle");
  if (smooth) weighted_median_.record(recorder, {checked, pair.left}, d_q4, size_);
}

}  // namespace duo::vk
