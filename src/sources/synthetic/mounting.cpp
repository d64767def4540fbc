#include "sources/synthetic/mounting.h"

#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

constexpr double kFocalAt640_px = 560;

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

}  // namespace

Camera ideal_camera(Size size) {
  const double f = kFocalAt640_px * size.width / 640;
  return {size, f, f, (size.width - 1) / 2.0, (size.height - 1) / 2.0, {}};
}

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

Rig rig_of(const Mounting& mounting) {
  Rig rig;
  rig.left = mounting.left.camera;
  rig.right = mounting.right.camera;
  rig.right_from_left = inverse(mounting.right.rig_from_camera) * mounting.left.rig_from_camera;
  return rig;
}

Picture taken(Image<Rgb8> pixels, double t_s) {
  Picture picture;
  picture.pixels = std::move(pixels);
  picture.t_ns = static_cast<TimeNs>(std::floor(t_s * 1e9 + 0.5));
  return picture;
}

}  // namespace duo::synthetic
