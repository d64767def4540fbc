#include "sources/synthetic/backdrop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace duo::synthetic {
namespace {

constexpr int kWindow = 0, kCeiling = 1, kAmbient = 2;
constexpr Color kDark{};

// The room in the light of one group alone.
Scene lit_by(const Scene& room, int group) {
  Scene out = room;
  if (group != kAmbient) {
    out.panels = {room.panels[group]};
    out.ambient_up = out.ambient_down = kDark;
    for (Material& material : out.materials) material.emission = 0;
  } else {
    out.panels.clear();
  }
  if (group != kWindow) out.sun.power = kDark;
  return out;
}

// The share of a panel's light that the figure lets through to a point.
double open_share(const Scene& figure, const Panel& panel, const Surface& s) {
  constexpr int kSide = 4;
  constexpr double kLift_m = 1e-3;
  const Vec3 from = s.p_in_world_m + kLift_m * s.normal;
  int open = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const Vec3 on_panel = panel.centre_m + ((2 * i + 1.0) / kSide - 1) * panel.u_m + ((2 * j + 1.0) / kSide - 1) * panel.v_m;
      open += !figure.blocked({from, on_panel - from});
    }
  return open / double{kSide * kSide};
}

struct Open {
  double window = 1, ceiling = 1;
};

// Shadows on a lattice of pixels; lamps as large as these give none that is finer.
struct Shadows {
  static constexpr int kStep_px = 8;
  Image<Open> nodes;

  static int node_px(int i, int size) { return std::min(i * kStep_px, size - 1); }

  Open at(const Image<Surface>& surfaces, int y, int x) const {
    const int i = y / kStep_px, j = x / kStep_px;
    const double v = double(y % kStep_px) / kStep_px, u = double(x % kStep_px) / kStep_px;
    Open sum{0, 0};
    double weights = 0;
    for (int di = 0; di < 2; ++di)
      for (int dj = 0; dj < 2; ++dj) {
        const Open& node = nodes.at(i + di, j + dj);
        const int yy = node_px(i + di, surfaces.height()), xx = node_px(j + dj, surfaces.width());
        const double same = same_surface(surfaces.at(y, x), surfaces.at(yy, xx)) ? 1 : 1e-3;
        const double weight = same * ((di != 0 ? v : 1 - v) * (dj != 0 ? u : 1 - u) + 1e-6);
        sum.window += weight * node.window;
        sum.ceiling += weight * node.ceiling;
        weights += weight;
      }
    return {sum.window / weights, sum.ceiling / weights};
  }

  bool any_near(int y, int x) const {
    const int i = y / kStep_px, j = x / kStep_px;
    for (int k = 0; k < 4; ++k) {
      const Open& node = nodes.at(i + k / 2, j + k % 2);
      if (node.window < 1 || node.ceiling < 1) return true;
    }
    return false;
  }
};

}  // namespace

void light_like(const Scene& room, const Lamps& lamps, Scene& into) {
  into.lift_m = 4e-3;  // round bodies: a march along the surface would be slow
  into.panels = room.panels;
  into.panels[kCeiling].power = lamps.ceiling * into.panels[kCeiling].power;
  into.sun = room.sun;
  into.sun.power = kDark;
  into.ambient_up = lamps.ambient() * room.ambient_up;
  into.ambient_down = lamps.ambient() * room.ambient_down;
}

Backdrop::Backdrop(Pool& pool, const Scene& room, const Camera& camera, const Rigid3& world_from_camera)
    : camera_(camera), world_from_camera_(world_from_camera), rays_(camera.size) {
  DUO_CHECK(room.panels.size() == panels_.size());
  std::copy(room.panels.begin(), room.panels.end(), panels_.begin());
  each_row(pool, camera.size.height, [&](int y) {
    for (int x = 0; x < camera.size.width; ++x)
      rays_.at(y, x) = unproject(camera, {static_cast<double>(x), static_cast<double>(y)});
  });
  for (int group = 0; group < kGroups; ++group) {
    Rendering rendering = render(pool, lit_by(room, group), camera, world_from_camera);
    groups_[group] = std::move(rendering.colors);
    surfaces_ = std::move(rendering.surfaces);
  }
}

Backdrop::Drawn Backdrop::draw(Pool& pool, const Scene& figure, const Lamps& lamps) const {
  Drawn out{Image<Color>(camera_.size), Image<float>(camera_.size), Image<std::uint8_t>(camera_.size)};
  draw_room(pool, figure, lamps, out);
  draw_figure(pool, figure, outline(figure), out);
  return out;
}

// The pixels that the boxes around the figure's shapes can cover.
Backdrop::Box2 Backdrop::outline(const Scene& figure) const {
  constexpr double kNear_m = 0.1, kWidest = 1.2;  // farther out a lens may fold back
  const Rigid3 camera_from_world = inverse(world_from_camera_);
  const int w = camera_.size.width, h = camera_.size.height;
  double left = w, top = h, right = 0, bottom = 0;
  for (const Shape& shape : figure.shapes) {
    const Vec3 half = half_extent(shape.solid);
    for (int corner = 0; corner < 8; ++corner) {
      const auto sign = [corner](int bit) { return (corner >> bit & 1) != 0 ? 1.0 : -1.0; };
      const Vec3 p = camera_from_world * (shape.world_from_shape * Vec3{sign(0) * half.x, sign(1) * half.y, sign(2) * half.z});
      if (p.z < kNear_m) return {0, 0, w, h};
      const Point2 at = project(camera_, {std::clamp(p.x / p.z, -kWidest, kWidest), std::clamp(p.y / p.z, -kWidest, kWidest)});
      left = std::min(left, at.x), right = std::max(right, at.x);
      top = std::min(top, at.y), bottom = std::max(bottom, at.y);
    }
  }
  constexpr int kRim_px = 2;
  const auto px = [](double v, int most) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
  return {px(left - kRim_px, w), px(top - kRim_px, h), px(right + kRim_px, w), px(bottom + kRim_px, h)};
}

void Backdrop::draw_room(Pool& pool, const Scene& figure, const Lamps& lamps, Drawn& out) const {
  const int w = camera_.size.width, h = camera_.size.height;
  Shadows shadows{Image<Open>({(w - 1) / Shadows::kStep_px + 2, (h - 1) / Shadows::kStep_px + 2})};
  each_row(pool, shadows.nodes.height(), [&](int i) {
    for (int j = 0; j < shadows.nodes.width(); ++j) {
      const Surface& s = surfaces_.at(Shadows::node_px(i, h), Shadows::node_px(j, w));
      shadows.nodes.at(i, j) = {open_share(figure, panels_[kWindow], s), open_share(figure, panels_[kCeiling], s)};
    }
  });
  each_row(pool, h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      const Open open = shadows.any_near(y, x) ? shadows.at(surfaces_, y, x) : Open{};
      out.colors.at(y, x) = open.window * groups_[kWindow].at(y, x) +
                            (open.ceiling * lamps.ceiling) * groups_[kCeiling].at(y, x) +
                            lamps.ambient() * groups_[kAmbient].at(y, x);
      out.z_m.at(y, x) = static_cast<float>(surfaces_.at(y, x).z_m);
    }
  });
}

namespace {

// A part of a picture with the figure's surfaces and their light.
struct FigurePart {
  Image<Surface> surfaces;
  Image<Light> rough, light;
  explicit FigurePart(Size size) : surfaces(size), rough(size), light(size) {}

  // Whether pixels around show something else: then one point does not stand for the pixel.
  bool at_edge(int y, int x) const {
    const int shape = surfaces.at(y, x).shape;
    for (int yy = std::max(y - 1, 0); yy <= std::min(y + 1, surfaces.height() - 1); ++yy)
      for (int xx = std::max(x - 1, 0); xx <= std::min(x + 1, surfaces.width() - 1); ++xx)
        if (surfaces.at(yy, xx).shape != shape) return true;
    return false;
  }

  // The light of a pixel around that shows the same; at rims, of the one that faces the most alike.
  Light light_for(const Eye& eye, const Surface& s, int y, int x) const {
    double best = -1;
    Light light_there;
    for (int yy = std::max(y - 1, 0); yy <= std::min(y + 1, surfaces.height() - 1); ++yy)
      for (int xx = std::max(x - 1, 0); xx <= std::min(x + 1, surfaces.width() - 1); ++xx) {
        const Surface& there = surfaces.at(yy, xx);
        if (same_surface(s, there)) return light.at(yy, xx);
        const double alike = dot(s.normal, there.normal);
        if (there.shape == s.shape && alike > best) best = alike, light_there = light.at(yy, xx);
      }
    return best > 0 ? light_there : full_light(eye, s);
  }
};

}  // namespace

void Backdrop::draw_figure(Pool& pool, const Scene& figure, const Box2& box, Drawn& out) const {
  const Size size{box.right - box.left, box.bottom - box.top};
  if (size.empty()) return;
  const Eye eye{figure, camera_, world_from_camera_};
  FigurePart part(size);
  const auto seen = [&](const Ray& ray, double room_z_m) {
    const Hit hit = figure.trace(ray);
    return hit.t < room_z_m ? surface_at(figure, ray, hit) : Surface{};
  };
  each_row(pool, size.height, [&](int row) {
    for (int column = 0; column < size.width; ++column) {
      const int y = box.top + row, x = box.left + column;
      const Point2 on_plane = rays_.at(y, x);
      const Ray ray{world_from_camera_.t_m, world_from_camera_.rotation * Vec3{on_plane.x, on_plane.y, 1}};
      Surface& s = part.surfaces.at(row, column);
      s = seen(ray, surfaces_.at(y, x).z_m);
      if (s.shape < 0) continue;
      part.rough.at(row, column) = rough_light(eye, s, y, x);
      out.z_m.at(y, x) = static_cast<float>(s.z_m);
      out.is_figure.at(y, x) = 255;
    }
  });
  each_row(pool, size.height, [&](int row) {
    for (int column = 0; column < size.width; ++column)
      if (part.surfaces.at(row, column).shape >= 0)
        part.light.at(row, column) = averaged(part.surfaces, part.rough, row, column);
  });
  each_row(pool, size.height, [&](int row) {
    for (int column = 0; column < size.width; ++column) {
      const int y = box.top + row, x = box.left + column;
      Color& color = out.colors.at(y, x);
      if (!part.at_edge(row, column)) {
        const Surface& s = part.surfaces.at(row, column);
        if (s.shape >= 0) color = shade(eye, s, part.light.at(row, column), 0.8);
        continue;
      }
      Color sum;
      for (const Point2& point : kPixelPoints) {
        const Surface s = seen(eye.ray(x + point.x, y + point.y), surfaces_.at(y, x).z_m);
        sum = sum + 0.25 * (s.shape < 0 ? color : shade(eye, s, part.light_for(eye, s, row, column), 0.5));
      }
      color = sum;
    }
  });
}

}  // namespace duo::synthetic
