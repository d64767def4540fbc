#include "duoptic/synthetic.h"

#include <cmath>

#include "core/check.h"
#include "sources/synthetic/lens.h"
#include "sources/synthetic/mounting.h"
#include "sources/synthetic/render.h"
#include "sources/synthetic/room.h"

namespace duo {
namespace {

using namespace synthetic;

// Compares the ideal left picture's surfaces with what the right camera sees.
void compare(Pool& pool, const Scene& scene, const Rigid3& world_from_right, const Camera& camera, const Image<Surface>& left,
             SyntheticPair& out) {
  constexpr double kSame = 1e-4;  // share of the way from the camera
  const Rigid3 right_from_world = inverse(world_from_right);
  out.disparity_px = Image<float>(camera.size);
  out.seen_by_both = Image<std::uint8_t>(camera.size);
  pool.rows(camera.size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < camera.size.width; ++x) {
        const Surface& s = left.at(y, x);
        if (s.shape < 0) continue;
        out.disparity_px.at(y, x) = static_cast<float>(camera.fx_px * kBaseline_m / s.z_m);
        const Vec3 p = right_from_world * s.p_in_world_m;
        const Point2 at = project(camera, {p.x / p.z, p.y / p.z});
        if (at.x < 0 || at.x > camera.size.width - 1) continue;
        const Hit hit = scene.trace(Ray{world_from_right.t_m, s.p_in_world_m - world_from_right.t_m});
        out.seen_by_both.at(y, x) = hit.t > 1 - kSame ? 255 : 0;
      }
  });
}

}  // namespace

SyntheticPair render_synthetic(const SyntheticSetup& setup, int threads) {
  DUO_CHECK(!setup.size.empty());
  Pool pool(threads);
  const Scene scene = living_room(setup.seed, setup.t_s);
  const Mounting mounts = mounting(setup);
  const Rigid3 from_rig = world_from_rig(setup.seed);
  const Rigid3 world_from_left = from_rig * mounts.left.rig_from_camera,
               world_from_right = from_rig * mounts.right.rig_from_camera;

  SyntheticPair out;
  out.rig = synthetic_rig(setup);
  const Rendering left = render(pool, scene, mounts.left.camera, world_from_left);
  const Rendering right = render(pool, scene, mounts.right.camera, world_from_right);
  out.pair.left = taken(develop(pool, left.colors, webcam(setup, 0)), setup.t_s);
  out.pair.right = taken(develop(pool, right.colors, webcam(setup, 1)), setup.t_s);
  out.depth_left_m = Image<float>(setup.size);
  for (int y = 0; y < setup.size.height; ++y)
    for (int x = 0; x < setup.size.width; ++x) out.depth_left_m.at(y, x) = static_cast<float>(left.surfaces.at(y, x).z_m);
  if (setup.ideal) compare(pool, scene, world_from_right, mounts.right.camera, left.surfaces, out);
  return out;
}

Rig synthetic_rig(const SyntheticSetup& setup) { return rig_of(mounting(setup)); }

Rectified synthetic_rectified(const SyntheticSetup& setup) {
  const Camera camera = ideal_camera(setup.size);
  Rectified out;
  out.size = setup.size;
  out.focal_px = camera.fx_px;
  out.cx_px = camera.cx_px;
  out.cy_px = camera.cy_px;
  out.baseline_m = kBaseline_m;
  return out;
}

}  // namespace duo
