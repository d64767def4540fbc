#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/check.h"
#include "core/point.h"
#include "core/rotation.h"
#include "duoptic/paint.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr double kYaw_rad = -0.20, kPitch_rad = 0.09;  // the camera goes to the right and up
constexpr int kOversampling = 2;                       // drawn larger and averaged down: smooth edges
constexpr double kMaxStep_px = 2.5;                    // neighbours further apart in disparity lie on different things

struct Vertex {
  double u = 0, v = 0, z_m = 0;  // in the drawn picture; z_m = 0: none
  Rgb8 color;
};

template <class Get>
double vertex_quantile(const std::vector<Vertex>& vertices, double share, const Get& get) {
  std::vector<double> values;
  values.reserve(vertices.size());
  for (const Vertex& vertex : vertices)
    if (vertex.z_m > 0) values.push_back(get(vertex));
  return values.empty() ? 0 : quantile(values, share);
}

/// Points seen from beside: the camera circles around the middle of the scene. u and v are tangents.
std::vector<Vertex> seen_from_beside(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified) {
  std::vector<Vertex> vertices(static_cast<std::size_t>(d_q4.width()) * static_cast<std::size_t>(d_q4.height()));
  std::vector<double> depths_m;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      if (const auto p = point_at(d_q4, rectified, y, x)) depths_m.push_back(p->z);
  if (depths_m.empty()) return vertices;
  const double middle_m = median(depths_m);
  const Mat3 turn = rotation_of({kPitch_rad, 0, 0}) * rotation_of({0, kYaw_rad, 0});
  const Vec3 middle_in_rig_m = {0, 0, middle_m};
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x) {
      const auto p = point_at(d_q4, rectified, y, x);
      if (!p) continue;
      const Vec3 q = turn * (*p - middle_in_rig_m) + middle_in_rig_m;
      if (q.z < 0.05 * middle_m || p->z > 6 * middle_m) continue;
      vertices[static_cast<std::size_t>(y) * static_cast<std::size_t>(d_q4.width()) + static_cast<std::size_t>(x)] = {
          q.x / q.z, q.y / q.z, q.z, color.at(y, x)};
    }
  return vertices;
}

/// Shifts and scales tangents so that nearly all of the scene fills the picture.
void fit(std::vector<Vertex>& vertices, Size size) {
  const auto u = [](const Vertex& vertex) { return vertex.u; };
  const auto v = [](const Vertex& vertex) { return vertex.v; };
  const double u0 = vertex_quantile(vertices, 0.01, u), u1 = vertex_quantile(vertices, 0.99, u);
  const double v0 = vertex_quantile(vertices, 0.01, v), v1 = vertex_quantile(vertices, 0.99, v);
  const double scale = 0.92 * std::min(size.width / std::max(u1 - u0, 1e-6), size.height / std::max(v1 - v0, 1e-6));
  for (Vertex& vertex : vertices) {
    vertex.u = (vertex.u - (u0 + u1) / 2) * scale + 0.5 * size.width;
    vertex.v = (vertex.v - (v0 + v1) / 2) * scale + 0.5 * size.height;
  }
}

/// A picture with a depth for each pixel; triangles keep what is nearest.
class Canvas {
 public:
  explicit Canvas(Size size) : color_(size), z_m_(size) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const double down = static_cast<double>(y) / size.height;
        const auto shade = [&](double top, double bottom) { return static_cast<std::uint8_t>(top + (bottom - top) * down); };
        color_.at(y, x) = {shade(44, 14), shade(49, 16), shade(60, 20)};
        z_m_.at(y, x) = std::numeric_limits<float>::max();
      }
  }

  void triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
    const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    if (std::abs(area) < 1e-9) return;
    const auto [left, right] = span(a.u, b.u, c.u, color_.width());
    const auto [top, bottom] = span(a.v, b.v, c.v, color_.height());
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) {
        const double wb = ((x - a.u) * (c.v - a.v) - (y - a.v) * (c.u - a.u)) / area;
        const double wc = ((b.u - a.u) * (y - a.v) - (b.v - a.v) * (x - a.u)) / area;
        const double wa = 1 - wb - wc;
        if (wa < 0 || wb < 0 || wc < 0) continue;
        const auto z_m = static_cast<float>(wa * a.z_m + wb * b.z_m + wc * c.z_m);
        if (z_m >= z_m_.at(y, x)) continue;
        z_m_.at(y, x) = z_m;
        const auto mix = [&](std::uint8_t Rgb8::*channel) {
          return static_cast<std::uint8_t>(wa * a.color.*channel + wb * b.color.*channel + wc * c.color.*channel + 0.5);
        };
        color_.at(y, x) = {mix(&Rgb8::r), mix(&Rgb8::g), mix(&Rgb8::b)};
      }
  }

  Image<Rgb8>& color() { return color_; }

 private:
  /// The whole pixels between three coordinates, within the picture.
  static std::pair<int, int> span(double a, double b, double c, int length) {
    const double low = std::ceil(std::min({a, b, c})), high = std::floor(std::max({a, b, c}));
    return {static_cast<int>(std::max(low, 0.0)), static_cast<int>(std::min(high, length - 1.0))};
  }

  Image<Rgb8> color_;
  Image<float> z_m_;
};

cv::Mat mat_of(Image<Rgb8>& picture) {
  return {picture.height(), picture.width(), CV_8UC3, picture.row(0),
          static_cast<std::size_t>(picture.stride()) * sizeof(Rgb8)};
}

}  // namespace

// Neighbouring pixels of one surface are joined by triangles, so that slanted surfaces have no gaps.
Image<Rgb8> draw_cloud(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified, Size size) {
  DUO_CHECK(d_q4.size() == color.size() && !size.empty());
  const Size large = {size.width * kOversampling, size.height * kOversampling};
  std::vector<Vertex> vertices = seen_from_beside(d_q4, color, rectified);
  fit(vertices, large);
  Canvas canvas(large);
  const auto vertex = [&](int y, int x) -> const Vertex& {
    return vertices[static_cast<std::size_t>(y) * static_cast<std::size_t>(d_q4.width()) + static_cast<std::size_t>(x)];
  };
  const auto joined = [&](int ya, int xa, int yb, int xb, int yc, int xc) {
    const auto [low, high] = std::minmax({d_q4.at(ya, xa), d_q4.at(yb, xb), d_q4.at(yc, xc)});
    if (high - low > kMaxStep_px * 16) return;
    const Vertex &a = vertex(ya, xa), &b = vertex(yb, xb), &c = vertex(yc, xc);
    if (a.z_m > 0 && b.z_m > 0 && c.z_m > 0) canvas.triangle(a, b, c);
  };
  for (int y = 0; y + 1 < d_q4.height(); ++y)
    for (int x = 0; x + 1 < d_q4.width(); ++x) {
      joined(y, x, y, x + 1, y + 1, x);
      joined(y, x + 1, y + 1, x + 1, y + 1, x);
    }
  Image<Rgb8> out(size);
  cv::Mat small = mat_of(out);
  cv::resize(mat_of(canvas.color()), small, small.size(), 0, 0, cv::INTER_AREA);
  return out;
}

}  // namespace duo
