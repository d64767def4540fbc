// Whether the pairs of a run fit their rig, and each other.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "duoptic/frame.h"
#include "duoptic/rig.h"
#include "duoptic/rig_health.h"

namespace [[gnu::visibility("default")]] duo {

struct RigFit {
  RigVerdict verdict = RigVerdict::kGood;  // also where nothing can be told
  std::string what = {};                   // one line: what is wrong, by how much, and what to do; empty: nothing
  std::optional<SceneHealth> scene = {};   // none: there is no rig, or the pairs show too little
  double disparity_sigma_px = 0;           // by how much disparities may be off all over the picture because of it
};

/// Judges by the numbers of the rig, where they are of no use, and by the pairs as scene_health() does. Without a rig, and
/// where the two views do not agree, it looks for what is known to go wrong: left and right swapped, both mirrored, one picture
/// twice, one camera on its head, on its side or mirrored, pictures that have nothing in common. What the pairs do not tell for
/// sure is good. Where all is right beyond doubt the first pair is enough, some 30 ms at 640x480; else all are looked at, and
/// where these leave a doubt about a metric rig, the mean of all, if there are four or more: the cameras must have stood still.
RigFit rig_fit(const std::optional<Rig>& rig, std::span<const std::shared_ptr<const Pair>> pairs, int threads);

}  // namespace duo
