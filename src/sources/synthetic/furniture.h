// Things to put into a room. Each is built around the point where it stands: y = 0 is the floor (or table top) under it,
// and heights are negative y.
#pragma once

#include "sources/synthetic/noise.h"
#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// Adds shapes in the frame of something that stands or hangs in the world.
class Group {
 public:
  Group(Scene& scene, const Rigid3& world_from_group) : scene_(scene), world_from_group_(world_from_group) {}

  Scene& scene() const { return scene_; }
  void add(const Solid& solid, Vec3 at_m, int material, const Mat3& turn = {}) const;
  void box(Vec3 at_m, Vec3 half_m, int material, double rounding_m = 0, const Mat3& turn = {}) const;
  /// A capsule from one point to another.
  void limb(Vec3 from_m, Vec3 to_m, double radius_m, int material) const;
  /// A group inside this one.
  Group at(Vec3 at_m, const Mat3& turn = {}) const { return {scene_, world_from_group_ * Rigid3{turn, at_m}}; }

 private:
  Scene& scene_;
  Rigid3 world_from_group_;
};

void add_table(const Group& group, Vec3 size_m, int wood);
void add_chair(const Group& group, int wood, int cushion);
void add_sofa(const Group& group, double width_m, int fabric, int cushion_a, int cushion_b);
void add_teddy(const Group& group, double height_m, int fur, int snout, int eyes, int bow);
void add_shelf(const Group& group, Random& random, int wood);
void add_books(const Group& group, Random& random, int count);  // a stack
void add_floor_lamp(const Group& group, double height_m, int metal, int shade);
void add_plant(const Group& group, Random& random, double height_m, int pot, int soil, int leaf, int stem);
void add_mug(const Group& group, int glaze, int drink);
void add_globe(const Group& group, double radius_m, double turned_degrees, int map, int metal);

/// A book's cover, print and paper.
Material book_cover(Random& random);

}  // namespace duo::synthetic
