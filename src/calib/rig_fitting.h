// The two steps of rig_fit(), for who has other work between them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "calib/scene_matches.h"
#include "calib/scene_patches.h"
#include "duoptic/rig_fit.h"

namespace duo {

/// Whether some pairs fit a rig: by the first of them what is beyond doubt, then by all.
class RigFitting {
 public:
  /// Pictures of `size`. Takes its memory when it is used. `most`: how a pair is searched where a quick search leaves a doubt.
  /// `still`: it is one pair of photos, between which things may have moved.
  RigFitting(std::optional<Rig> rig, Size size, int threads, SceneSearch most = SceneSearch::kThorough, bool still = false);

  /// What the first pair tells beyond doubt, right or wrong; none where others have to be looked at, too. To be called once.
  std::optional<RigFit> by_first(const std::shared_ptr<const Pair>& pair);
  /// What the first and these tell, after by_first() told nothing; where they leave a doubt, what the sum of all pairs so far
  /// tells; null: there is none.
  RigFit by_all(std::span<const std::shared_ptr<const Pair>> others, const PairSum* sum);
  /// Whether by_all() may look at a sum.
  bool looks_at_sum() const;

 private:
  std::optional<RigFit> by_matches(const SceneMatches& scene, const Pair& last) const;
  RigFit by_agreeing(const SceneMatches& scene, const std::vector<SceneMatch>& matches) const;
  std::optional<RigFit> by_sum(const PairSum& sum) const;
  void add(const std::shared_ptr<const Pair>& pair);

  const std::optional<Rig> rig_;
  const Rig lenses_;  // of the rig, or a guess
  const Size size_;
  const int threads_;
  const SceneSearch most_;
  const bool still_;
  std::optional<RigFit> first_;          // by all points of the first pair, though not beyond doubt
  std::optional<SceneMatcher> matcher_;  // of all pairs that were added
  std::shared_ptr<const Pair> last_;
};

}  // namespace duo
