#include "matchers/sgm/sgm.h"

#include "stages/balance/balance.h"
#include "stages/check_left_right/check_left_right.h"
#include "stages/match_planes/match_planes.h"

namespace duo::ref {

Sgm::Sgm(const SgmParams& params, const MatchSetup& setup)
    : params_(params), max_disparity_(setup.max_disparity), maps_(setup.size), left_(setup.size, 0), right_(setup.size, 0) {}

void Sgm::match(const GrayPair& pair, const SgmMatch& out, StageTimer& timer) {
  ref::balance(pair, maps_.balanced);
  timer.stage("balance");
  ref::match_planes(pair.left, pair.left_inside, left_);
  ref::match_planes(maps_.balanced, pair.right_inside, right_);
  timer.stage("match_planes");
  const SemiGlobal in{left_.planes(), right_.planes(), max_disparity_, params_.semi_global()};
  ref::semi_global(in, {maps_.left_winner, maps_.right_winner, maps_.fine, out.confidence});
  timer.stage("semi_global");
  // The weighted median writes to another image than it reads: the check starts in the one from which it ends in d_q4.
  const View<std::uint16_t> checked = params_.smooth != 0 ? maps_.checked.view() : out.d_q4;
  ref::check_left_right(
      {maps_.left_winner, maps_.right_winner, pair.left_inside, pair.right_inside, params_.tolerance, params_.reach},
      maps_.fine, checked);
  timer.stage("check_left_right");
  ref::remove_speckle(checked, params_.speckle_step_q4, params_.speckle);
  timer.stage("speckle");
  if (params_.smooth != 0) ref::weighted_median({checked, pair.left}, out.d_q4);
  if (!out.confidence.empty()) keep_confidence(out.d_q4, out.confidence);
  timer.stage("weighted_median");
}

}  // namespace duo::ref
