#include "duoptic/synthetic.h"

#include <cmath>

#include "core/check.h"
#include "sources/synthetic/lens.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/render.h"
#include "sources/synthetic/room.h"
#include "sources/synthetic/webcam.h"

namespace duo {
namespace {

using namespace synthetic;

constexpr double kFocalAt640_px = 560, kBaseline_m = 0.127;

Camera ideal_camera(Size size) {
  const double f = kFocalAt640_px * size.width / 640;
  return {size, f, f, (size.width - 1) / 2.0, (size.height - 1) / 2.0, {}};
}

// Two webcams of one make, screwed on a bar by hand: every lens and every mount is a little off.
Camera made_camera(Size size, Random& random) {
  Camera camera = ideal_camera(size);
  const double scale = size.width / 640.0;
  camera.fx_px *= 1 + random.uniform(-0.012, 0.012);
  camera.fy_px = camera.fx_px * (1 + random.uniform(-0.003, 0.003));
  camera.cx_px += scale * random.uniform(-6, 6);
  camera.cy_px += scale * random.uniform(-6, 6);
  camera.distortion = {-0.11 + random.uniform(-0.02, 0.02), 0.05 + random.uniform(-0.02, 0.02), random.uniform(-0.001, 0.001),
                       random.uniform(-0.001, 0.001), random.uniform(-0.01, 0.01)};
  return camera;
}

struct Mounted {
  Camera camera;
  Rigid3 rig_from_camera;
};
struct Mounting {
  Mounted left, right;
};

Mounting mounting(const SyntheticSetup& setup) {
  const Camera ideal = ideal_camera(setup.size);
  if (setup.ideal) return {{ideal, {}}, {ideal, {{}, {kBaseline_m, 0, 0}}}};
  Random random(setup.seed ^ 0xca3e4aU);
  const auto turned = [&](double degrees) {
    const auto either_way = [&] {
      const double size = random.uniform(0.3, 1.0);
      return random.pick(2) == 0 ? -size * degrees : size * degrees;
    };
    const double x = either_way(), y = either_way(), z = either_way();  // in this order whatever the compiler
    return about_x(x) * about_y(y) * about_z(z);
  };
  const auto off = [&] { return random.uniform(-0.003, 0.003); };
  const Camera left = made_camera(setup.size, random), right = made_camera(setup.size, random);
  const Mat3 left_turn = turned(0.8), right_turn = turned(1.2);
  return {{left, {left_turn, {}}}, {right, {right_turn, {kBaseline_m + off(), off(), off()}}}};
}

Webcam webcam(const SyntheticSetup& setup, std::uint32_t which) {
  if (setup.ideal) return {};
  Random random(hash(setup.seed, 0x3ca, static_cast<int>(which)));
  Webcam cam;
  const double exposure = random.uniform(0.93, 1.07);
  const auto channel = [&] { return static_cast<float>(exposure * random.uniform(0.96, 1.04)); };
  cam.gain.r = channel();
  cam.gain.g = channel();
  cam.gain.b = channel();
  cam.blur = random.uniform(0.08, 0.13);
  cam.vignetting = random.uniform(0.2, 0.32);
  cam.shot_noise = 0.012;
  cam.read_noise = 0.0011;
  const auto t_us = static_cast<std::int64_t>(std::floor(setup.t_s * 1e6 + 0.5));
  cam.seed = hash(random.bits(), static_cast<int>(t_us & 0x7FFFFFFF), static_cast<int>((t_us >> 31) & 0x7FFFFFFF));
  return cam;
}

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

Picture taken(Image<Rgb8> pixels, double t_s) {
  Picture picture;
  picture.pixels = std::move(pixels);
  picture.t_ns = static_cast<TimeNs>(std::floor(t_s * 1e9 + 0.5));
  return picture;
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

Rig synthetic_rig(const SyntheticSetup& setup) {
  const Mounting mounts = mounting(setup);
  Rig rig;
  rig.left = mounts.left.camera;
  rig.right = mounts.right.camera;
  rig.right_from_left = inverse(mounts.right.rig_from_camera) * mounts.left.rig_from_camera;
  return rig;
}

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
