// A person's flesh, hair and clothes on their bones.
#pragma once

#include <cstdint>

#include "sources/synthetic/bones.h"
#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// What a person looks like.
struct Looks {
  double scale = 1, girth = 1;  // of all lengths; of trunk, thighs and shins beside that
  bool long_sleeves = false, long_hair = false;
  Material face, skin, hair, shirt, trousers, shoes;
};

/// The look of a seed. Seed 1 wears a printed T-shirt.
Looks looks_of(std::uint32_t seed);
/// Another of that seed: shorter, taller, slimmer, stouter people in other clothes.
Looks passer_by_of(std::uint32_t seed);

/// Adds the person's shapes to a scene.
void add_figure(Scene& scene, const Rigid3& world_from_person, const Bones& bones, const Looks& looks);

}  // namespace duo::synthetic
