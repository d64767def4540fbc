// Structured light in the rendered room: two distorted, noisy webcams, a projector above them, shadows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/rectification.h"
#include "duoptic/structured_light.h"
#include "sources/synthetic/lens.h"
#include "sources/synthetic/mounting.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/projector.h"
#include "sources/synthetic/room.h"

namespace duo {
namespace {

using namespace synthetic;

constexpr Size kRaw = {480, 360};
constexpr LightCode kLightCode{{1200, 900}, 32};

/// A rig in the room, before a projector that stands above it and lights what it sees.
class LitRoom {
 public:
  explicit LitRoom(const SyntheticSetup& setup)
      : setup_(setup),
        scene_(living_room(setup.seed, 0)),
        mounts_(mounting(setup)),
        world_from_rig_(world_from_rig(setup.seed)),
        projector_{world_from_rig_ * Rigid3{about_x(-4), {0.05, -0.22, 0.02}},
                   kLightCode.screen,
                   0.7 * kLightCode.screen.width,
                   {2.5F, 2.5F, 2.5F}},
        left_(pool_, scene_, projector_, mounts_.left.camera, world_from_rig_ * mounts_.left.rig_from_camera),
        right_(pool_, scene_, projector_, mounts_.right.camera, world_from_rig_ * mounts_.right.rig_from_camera) {}

  Rig rig() const { return rig_of(mounts_); }

  /// What the webcams make of a pattern in a dim room: the mean of four pictures, which has half the noise of one.
  Pair shown(std::size_t number, double bright) {
    constexpr double kDim = 0.2;
    const auto pattern = draw_pattern(kLightCode, light_patterns(kLightCode)[number]);
    Pair out;
    for (const bool is_left : {true, false}) {
      Webcam cam = webcam(setup_, is_left ? 0 : 1);
      cam.gain = bright * cam.gain;
      cam.shot_noise /= 2, cam.read_noise /= 2;
      cam.seed = hash(cam.seed, static_cast<int>(number), static_cast<int>(100 * bright));
      (is_left ? out.left : out.right).pixels = develop(pool_, (is_left ? left_ : right_).draw(pool_, pattern, kDim), cam);
    }
    return out;
  }

  /// True disparity where both cameras see a surface and the projector lights it; else none.
  Image<float> seen_and_lit(const Rectification& maps) const {
    const Rectified& r = maps.geometry;
    const Rigid3 world_from_left = world_from_rig_ * mounts_.left.rig_from_camera,
                 right_from_world = inverse(world_from_rig_ * mounts_.right.rig_from_camera);
    const Mat3 left_from_rig = transposed(r.rig_from_left);
    Image<float> out(r.size);
    for (int y = 0; y < r.size.height; ++y)
      for (int x = 0; x < r.size.width; ++x) {
        if (maps.left.corner.at(y, x) == ResampleMap::kOutside) continue;
        const Vec3 way = left_from_rig * r.unproject({double(x), double(y)}, 1);
        const Ray ray{world_from_left.t_m, world_from_left.rotation * way};
        const Hit hit = scene_.trace(ray);
        const Surface s = surface_at(scene_, ray, hit);
        const double d = r.disparity_px(hit.t);
        const int column = static_cast<int>(std::lround(x - d));
        if (column < 0 || maps.right.corner.at(y, column) == ResampleMap::kOutside) continue;
        const Vec3 from_right = inverse(right_from_world).t_m;
        const bool seen = scene_.trace(Ray{from_right, s.p_in_world_m - from_right}).t > 1 - 1e-4;
        if (seen && is_lit(scene_, projector_, s)) out.at(y, x) = static_cast<float>(d);
      }
    return out;
  }

 private:
  Pool pool_{2};
  SyntheticSetup setup_;
  Scene scene_;
  Mounting mounts_;
  Rigid3 world_from_rig_;
  Projector projector_;
  ProjectedView left_, right_;
};

struct Score {
  std::int64_t pixels = 0, found = 0, right = 0;
  void add(float got_px, float want_px) {
    ++pixels;
    found += got_px > 0;
    right += got_px > 0 && std::abs(got_px - want_px) <= 0.2f;
  }
  double percent_found() const { return 100.0 * static_cast<double>(found) / static_cast<double>(pixels); }
  double percent_right() const { return 100.0 * static_cast<double>(right) / static_cast<double>(found); }
};

/// Whether a pixel and those around it show one smooth surface: then it has one true disparity. Beside edges it sees two.
bool on_one_surface(const Image<float>& want, int y, int x) {
  constexpr float kBent_px = 0.1f;
  for (int v = -1; v <= 1; ++v)
    for (int u = -1; u <= 1; ++u) {
      const float a = want.at(y + v, x + u), b = want.at(y - v, x - u);
      if (a == 0 || b == 0 || std::abs(a + b - 2 * want.at(y, x)) > 2 * kBent_px) return false;
    }
  return true;
}

TEST(LightRoom, TruthIsTrue) {
  LitRoom room({.size = kRaw, .seed = 3});
  const auto maps = make_rectification(room.rig(), "");
  ASSERT_TRUE(maps.has_value());
  auto decoder = LightDecoder::open(kLightCode, room.rig(), kRaw, 2);
  ASSERT_TRUE(decoder.has_value()) << decoder.error().what;
  // Two exposures: the far corners are dark in the one, what is near is bright in the other.
  for (const double bright : {1.0, 4.0})
    for (std::size_t i = 0; i < light_patterns(kLightCode).size(); ++i)
      ASSERT_TRUE(decoder->add(room.shown(i, bright)).has_value());
  const auto truth = decoder->truth();
  ASSERT_TRUE(truth.has_value()) << truth.error().what;
  const Image<float> want = room.seen_and_lit(*maps);
  ASSERT_EQ(truth->disparity_px.size(), want.size());
  Score on_surfaces, all;
  std::int64_t elsewhere = 0;
  for (int y = 1; y + 1 < want.height(); ++y)
    for (int x = 1; x + 1 < want.width(); ++x) {
      const float got = truth->disparity_px.at(y, x);
      if (want.at(y, x) == 0) {
        elsewhere += got > 0;
        continue;
      }
      all.add(got, want.at(y, x));
      if (on_one_surface(want, y, x)) on_surfaces.add(got, want.at(y, x));
    }
  RecordProperty("all", fmt::format("{:.2f} % found, {:.2f} % of them right", all.percent_found(), all.percent_right()));
  RecordProperty("surfaces", fmt::format("{:.2f} % found, {:.2f} % of them right", on_surfaces.percent_found(),
                                         on_surfaces.percent_right()));
  EXPECT_GT(on_surfaces.pixels, all.pixels * 3 / 4);
  EXPECT_GE(on_surfaces.percent_found(), 95);
  EXPECT_GE(on_surfaces.percent_right(), 99);
  EXPECT_GE(all.percent_found(), 92);
  EXPECT_GE(all.percent_right(), 96.5);
  EXPECT_LT(elsewhere, all.pixels / 50);
  EXPECT_NEAR(truth->rows_px, 0, 0.02);
  EXPECT_GT(truth->left.unlit, truth->left.pixels / 100);
}

}  // namespace
}  // namespace duo
