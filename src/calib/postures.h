// Pairs whose views have little in common: one camera is held or set up in another way, or looks elsewhere.
#pragma once

#include <cstddef>
#include <string>

#include "calib/scene_matches.h"
#include "duoptic/frame.h"

namespace duo {

inline constexpr int kManyPoints = 100;  // in either picture: a scene with texture, in light

/// Matches of a pair.
std::size_t alike_in(const SceneMatches& scene);
/// Of one place, seen the same way, however few points agree.
bool are_of_one_scene(const SceneMatches& scene);

/// One camera is on its head, on its side, mirrored, from bottom to top or a negative: told by the points that are alike once
/// that is undone. Some 30 ms for each at 640x480. Empty: it is not known.
std::string why_held_otherwise(const SceneMatches& scene, const Pair& pair, int threads);
/// The same, or that they have nothing in common.
std::string why_apart(const SceneMatches& scene, const Pair& pair, int threads);

}  // namespace duo
