// The cells that matter to one arm: what stands before the background within reach, and which of it is this arm's skin.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trackers/arm/background.h"
#include "trackers/arm/body_map.h"
#include "trackers/arm/color_table.h"
#include "trackers/arm/params.h"
#include "trackers/arm/regions.h"

namespace duo::arm {

/// Skin that is not this hand: the head, which moves with the torso, or another hand.
struct OtherSkin {
  Vec3 p, p_in_torso_m;
  bool head = false;
  int unseen = 0;
};

struct SilhouetteInput {
  const Grid& grid;
  const Background& background;
  const ColorTable& colors;
  const BodyMap &body_skin, &body;
  std::span<const OtherSkin> others;
  Rigid3 torso_from_rig;
  Vec3 shoulder, hand;
  bool hand_seen;
  double reach_m;
};

class Silhouette {
 public:
  Silhouette() = default;
  explicit Silhouette(const Grid& grid);
  void find(const SilhouetteInput& in, const Params& params);

  std::vector<std::uint8_t> front;     // the person, and what stands as near
  std::vector<std::uint8_t> any_skin;  // of it: skin colour, within the arm's reach
  std::vector<std::uint8_t> skin;      // of it: not the head's, the other hand's or the body's
  std::vector<std::uint8_t> solid;     // of it: most cells within 1 cm are skin too
  std::vector<std::uint8_t> body;      // of front: where the body's surface is known to be

 private:
  void find_front(const SilhouetteInput& in);
  void find_skin(const SilhouetteInput& in, const Params& params);
  void find_solid(const Grid& grid);
  Regions regions_;
  std::vector<std::uint8_t> scratch_;
};

}  // namespace duo::arm
