#include "calib/rectification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "calib/rig_formats.h"

namespace duo {
namespace {

constexpr double kNearest_m = 0.4;
constexpr double kMinCosine = 0.1;  // rays further than 84 degrees from the z axis fit on no flat picture
constexpr double kMaxGrowth = 1.5, kMinZoom = 0.5;

/// A range of tangents; empty when min > max.
struct Range {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  void add(double v) {
    min = std::min(min, v);
    max = std::max(max, v);
  }
  double length() const { return max - min; }
};
Range common(Range a, Range b) { return {std::max(a.min, b.min), std::min(a.max, b.max)}; }
Range both(Range a, Range b) { return {std::min(a.min, b.min), std::max(a.max, b.max)}; }

/// What a raw picture covers in the rig frame, as tangents of the rectified rays.
struct Footprint {
  Range x, y;
};

// The extremes lie on the boundary of what is seen: the border of the picture, or, where a lens turns back before the
// corners, the circle of its last rays.
Footprint footprint(const Lens& lens, const Mat3& rig_from_camera) {
  Footprint seen;
  const auto add = [&](Vec3 ray) {
    const Vec3 p = rig_from_camera * ray;
    if (p.z < kMinCosine * norm(p)) return;
    seen.x.add(p.x / p.z);
    seen.y.add(p.y / p.z);
  };
  const auto add_pixel = [&](int x, int y) {
    if (const auto ray = lens.ray_of({double(x), double(y)})) add(*ray);
  };
  const auto [w, h] = lens.camera().size;
  for (int x = 0; x < w; ++x) add_pixel(x, 0), add_pixel(x, h - 1);
  for (int y = 0; y < h; ++y) add_pixel(0, y), add_pixel(w - 1, y);
  constexpr int kSteps = 2048;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSteps;
    const Vec3 ray = {lens.max_tangent() * std::cos(angle), lens.max_tangent() * std::sin(angle), 1};
    if (const auto pixel = lens.pixel_of(ray); pixel && lens.covers(*pixel)) add(ray);
  }
  return seen;
}

Mat3 rig_from_left_camera(const Rigid3& right_from_left) {
  const Mat3 left_from_right = transposed(right_from_left.rotation);
  const Vec3 x = normalized(inverse(right_from_left).t_m);
  const Vec3 mean_axis = normalized(Vec3{0, 0, 1} + left_from_right * Vec3{0, 0, 1});
  const Vec3 z = normalized(mean_axis - dot(mean_axis, x) * x);
  return Mat3::from_rows(x, cross(z, x), z);
}

double angle_between_axes_deg(const Rig& rig) {
  return std::acos(std::clamp(rig.right_from_left.rotation(2, 2), -1.0, 1.0)) * 180 / std::numbers::pi;
}

/// A place as the first of the two pixels it lies between, and the fraction in 1/256. The very last pixel is reached with
/// the largest fraction, 255/256 of a pixel, instead of being lost.
std::pair<std::uint32_t, std::uint32_t> split(double at_px, int length) {
  const auto at_q8 = static_cast<std::uint32_t>(std::clamp(std::lround(at_px * 256), 0L, (length - 1) * 256L - 1));
  return {at_q8 >> 8, at_q8 & 0xFF};
}

ResampleMap make_map(const Rectified& geometry, const Mat3& rig_from_camera, const Lens& lens) {
  constexpr double kRounding_px = 1.0 / 512;
  ResampleMap map{Image<std::uint32_t>(geometry.size), Image<std::uint16_t>(geometry.size)};
  for (int y = 0; y < geometry.size.height; ++y)
    for (int x = 0; x < geometry.size.width; ++x) {
      const auto raw = raw_from_rectified(geometry, rig_from_camera, lens, {double(x), double(y)});
      if (raw && lens.covers(*raw, kRounding_px))
        put_place(map, y, x, *raw, lens.camera().size);
      else
        map.corner.at(y, x) = ResampleMap::kOutside;
    }
  return map;
}

}  // namespace

void put_place(ResampleMap& map, int y, int x, Vec2 raw_px, Size raw) {
  constexpr double kRounding_px = 1.0 / 512;
  const auto inside = [&](double at_px, int length) { return at_px >= -kRounding_px && at_px <= length - 1 + kRounding_px; };
  if (!inside(raw_px.x, raw.width) || !inside(raw_px.y, raw.height)) {
    map.corner.at(y, x) = ResampleMap::kOutside;
    return;
  }
  const auto [x0, fx] = split(raw_px.x, raw.width);
  const auto [y0, fy] = split(raw_px.y, raw.height);
  map.corner.at(y, x) = x0 << 16 | y0;
  map.fraction_q8.at(y, x) = static_cast<std::uint16_t>(fx << 8 | fy);
}

std::optional<Vec2> rectified_from_raw(const Rectified& geometry, const Mat3& rig_from_camera, const Lens& lens, Vec2 raw_px) {
  const auto ray = lens.ray_of(raw_px);
  if (!ray) return {};
  const Vec3 p = rig_from_camera * *ray;
  if (p.z <= 0) return {};
  return geometry.project(p);
}

std::optional<Vec2> raw_from_rectified(const Rectified& geometry, const Mat3& rig_from_camera, const Lens& lens,
                                       Vec2 rectified_px) {
  return lens.pixel_of(transposed(rig_from_camera) *
                       Vec3{rectified_px.x - geometry.cx_px, rectified_px.y - geometry.cy_px, geometry.focal_px});
}

Result<Rectified> rectified_geometry(const Rig& rig, const std::string& name) {
  DUO_TRY(check_rig(rig, name));
  Rectified geometry;
  geometry.baseline_m = rig.baseline_m();
  geometry.rig_from_left = rig_from_left_camera(rig.right_from_left);
  geometry.rig_from_right = geometry.rig_from_left * transposed(rig.right_from_left.rotation);
  const Lens left(rig.left), right(rig.right);
  const Footprint in_left = footprint(left, geometry.rig_from_left), in_right = footprint(right, geometry.rig_from_right);

  // A point at tangent x in the left view has x - baseline / z in the right one. Columns that meet no partner in the other
  // view at any z from kNearest_m on are useless, and so are rows outside of one view.
  const double reach = geometry.baseline_m / kNearest_m;
  const Range left_x = common(in_left.x, {in_right.x.min, in_right.x.max + reach});
  const Range right_x = common(in_right.x, {in_left.x.min - reach, in_left.x.max});
  const Range x = both(left_x, right_x), y = common(in_left.y, in_right.y);
  const double angle_deg = angle_between_axes_deg(rig);
  if (!(left_x.length() > 0 && right_x.length() > 0 && y.length() > 0))
    return rig_error(name,
                     "the two views have no common part (their axes differ by {:.1f} degrees); turn the cameras the same way",
                     angle_deg);

  const double raw_focal_px = (rig.left.fx_px + rig.left.fy_px + rig.right.fx_px + rig.right.fy_px) / 4;
  const double zoom = std::min({1.0, kMaxGrowth * rig.left.size.width / (x.length() * raw_focal_px),
                                kMaxGrowth * rig.left.size.height / (y.length() * raw_focal_px)});
  if (zoom < kMinZoom)
    return rig_error(name,
                     "the rectified picture would be {:.1f} times the raw one (the axes differ by {:.1f} degrees); turn the "
                     "cameras the same way",
                     kMaxGrowth / zoom, angle_deg);
  geometry.focal_px = zoom * raw_focal_px;
  geometry.cx_px = -x.min * geometry.focal_px;
  geometry.cy_px = -y.min * geometry.focal_px;
  // Up to the next whole pixel, but not for the sake of rounding errors.
  const auto pixels = [&](Range range) { return static_cast<int>(std::ceil(range.length() * geometry.focal_px - 1e-6)) + 1; };
  geometry.size = {pixels(x), pixels(y)};
  return geometry;
}

Result<Rectification> make_rectification(const Rig& rig, const std::string& name) {
  DUO_TRY_ASSIGN(const Rectified geometry, rectified_geometry(rig, name));
  return Rectification{geometry, make_map(geometry, geometry.rig_from_left, Lens(rig.left)),
                       make_map(geometry, geometry.rig_from_right, Lens(rig.right))};
}

}  // namespace duo
