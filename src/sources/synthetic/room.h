// The living room that the synthetic rig looks into.
#pragma once

#include <cstdint>

#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// Where the rig frame (the ideal left camera) stands in the world: x right, y down, z into the room, origin at the rig.
/// It looks a little down and aside.
Rigid3 world_from_rig(std::uint32_t seed);

/// Height of the floor in the world.
inline constexpr double kFloor_m = 1.05;

enum class Floor { kFurnished, kFree };  // free: room for a person between the rug and the ceiling

/// The room at a moment: a ball swings on a string and a globe turns, the rest is still. Surfaces lie 0.8 to 4 m away.
Scene living_room(std::uint32_t seed, double t_s, Floor floor = Floor::kFurnished);

}  // namespace duo::synthetic
