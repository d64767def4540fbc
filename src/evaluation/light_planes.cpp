// Places of a view's pixels on planes: a pixel beside an edge is told by those of its own surface.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "evaluation/light_code.h"
#include "stages/rectify/rectify.h"

namespace duo {
namespace {

/// Least squares of a window's places; u and v in pixels from its middle.
struct PlaceFit {
  float x = 0, x_u = 0, x_v = 0, y = 0, y_u = 0, y_v = 0;  // 1/256 px
  float rms = std::numeric_limits<float>::infinity();      // of the axis with more; none of a window with an unknown pixel

  float x_at(float u, float v) const { return x + x_u * u + x_v * v; }
  float y_at(float u, float v) const { return y + y_u * u + y_v * v; }
};

PlaceFit fit_places(const ViewPlaces& view, int y, int x, int radius) {
  PlaceFit out;
  const Size size = view.x_q8.size();
  if (y < radius || x < radius || y + radius >= size.height || x + radius >= size.width) return out;
  const int side = 2 * radius + 1, pixels = side * side;
  double mean[2] = {}, u_sum[2] = {}, v_sum[2] = {}, squares[2] = {};
  const std::int32_t middle[2] = {view.x_q8.at(y, x), view.y_q8.at(y, x)};
  for (int v = -radius; v <= radius; ++v)
    for (int u = -radius; u <= radius; ++u) {
      if (view.x_q8.at(y + v, x + u) < 0) return out;
      const double apart[2] = {double(view.x_q8.at(y + v, x + u) - middle[0]), double(view.y_q8.at(y + v, x + u) - middle[1])};
      for (const int k : {0, 1}) {
        mean[k] += apart[k] / pixels;
        u_sum[k] += u * apart[k], v_sum[k] += v * apart[k], squares[k] += apart[k] * apart[k];
      }
    }
  const double spread = pixels * radius * (radius + 1) / 3.0;  // sum of u^2, and of v^2
  double worst = 0;
  for (const int k : {0, 1}) {
    const double left = squares[k] - pixels * mean[k] * mean[k] - (u_sum[k] * u_sum[k] + v_sum[k] * v_sum[k]) / spread;
    worst = std::max(worst, left / (pixels - 3));
  }
  out.rms = static_cast<float>(std::sqrt(worst));
  out.x = static_cast<float>(middle[0] + mean[0]), out.y = static_cast<float>(middle[1] + mean[1]);
  out.x_u = static_cast<float>(u_sum[0] / spread), out.x_v = static_cast<float>(v_sum[0] / spread);
  out.y_u = static_cast<float>(u_sum[1] / spread), out.y_v = static_cast<float>(v_sum[1] / spread);
  return out;
}

/// Where in the raw picture a rectified pixel lies.
struct RawPlace {
  float x = 0, y = 0;
  bool inside = false;
};

RawPlace raw_place(const ResampleMap* map, int y, int x) {
  if (map == nullptr) return {static_cast<float>(x), static_cast<float>(y), true};
  if (x < 0 || x >= map->corner.width()) return {};
  const std::uint32_t corner = map->corner.at(y, x);
  if (corner == ResampleMap::kOutside) return {};
  const int fraction = map->fraction_q8.at(y, x);
  return {static_cast<float>(corner >> 16) + static_cast<float>(fraction >> 8) / 256,
          static_cast<float>(corner & 0xFFFF) + static_cast<float>(fraction & 255) / 256, true};
}

}  // namespace

PlacePlanes place_planes(Pool& pool, const ViewPlaces& raw, const ResampleMap* map, const LightCode& code) {
  constexpr int kRadii[] = {2, 1};
  // Noise goes by the period; and a pixel of the projector, which is lit all over alike, makes up to 0.29 of its width.
  const float most = static_cast<float>(std::max(96, 3 * code.period_px));
  const float farther = most / 4;
  const Size seen = raw.x_q8.size(), size = map != nullptr ? map->corner.size() : seen;
  std::array<Image<PlaceFit>, 2> fits = {Image<PlaceFit>(seen), Image<PlaceFit>(seen)};
  pool.rows(seen.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < seen.width; ++x)
        for (std::size_t i = 0; i < fits.size(); ++i) fits[i].at(y, x) = fit_places(raw, y, x, kRadii[i]);
  });
  const auto places = [&] { return ViewPlaces{Image<std::int32_t>(size), Image<std::int32_t>(size)}; };
  PlacePlanes out{places(), places()};
  pool.rows(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < size.width; ++x) {
        out.at.x_q8.at(y, x) = out.at.y_q8.at(y, x) = -1;
        const RawPlace here = raw_place(map, y, x);
        if (!here.inside) continue;
        const int near_x = static_cast<int>(here.x + 0.5f), near_y = static_cast<int>(here.y + 0.5f);
        if (near_x >= seen.width || near_y >= seen.height || raw.x_q8.at(near_y, near_x) < 0) continue;
        const PlaceFit* best = nullptr;
        int best_x = 0, best_y = 0;
        for (std::size_t i = 0; i < fits.size() && best == nullptr; ++i) {
          float least = std::numeric_limits<float>::infinity();
          for (int v = -kRadii[i]; v <= kRadii[i]; ++v)
            for (int u = -kRadii[i]; u <= kRadii[i]; ++u) {
              if (near_y + v < 0 || near_x + u < 0 || near_y + v >= seen.height || near_x + u >= seen.width) continue;
              const PlaceFit& fit = fits[i].at(near_y + v, near_x + u);
              const float all = fit.rms + farther * static_cast<float>(std::abs(u) + std::abs(v));
              if (fit.rms > most || all >= least) continue;
              least = all, best = &fit, best_x = near_x + u, best_y = near_y + v;
            }
        }
        if (best == nullptr) continue;
        const RawPlace before = raw_place(map, y, x - 1), after = raw_place(map, y, x + 1);
        if (!before.inside && !after.inside) continue;
        const RawPlace &from = before.inside ? before : here, &to = after.inside ? after : here;
        const float columns = before.inside && after.inside ? 2 : 1, u = (to.x - from.x) / columns,
                    v = (to.y - from.y) / columns;
        const float at_u = here.x - static_cast<float>(best_x), at_v = here.y - static_cast<float>(best_y);
        const auto rounded = [](float value) { return static_cast<std::int32_t>(std::lround(value)); };
        out.at.x_q8.at(y, x) = std::max(rounded(best->x_at(at_u, at_v)), 0);
        out.at.y_q8.at(y, x) = std::max(rounded(best->y_at(at_u, at_v)), 0);
        out.step.x_q8.at(y, x) = rounded(best->x_u * u + best->x_v * v);
        out.step.y_q8.at(y, x) = rounded(best->y_u * u + best->y_v * v);
      }
  });
  return out;
}

}  // namespace duo
