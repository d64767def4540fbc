#include "sources/synthetic/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace duo::synthetic {

Color srgb(std::uint32_t rrggbb) {
  // Cubic fit of the sRGB curve, error below 0.003: no pow(), whose last bit differs between C libraries.
  const auto linear = [&](int shift) {
    const float v = static_cast<float>((rrggbb >> shift) & 255) / 255;
    return v * (v * (v * 0.305306011F + 0.682171111F) + 0.012522878F);
  };
  return {linear(16), linear(8), linear(0)};
}

int Scene::add(const Material& material) {
  materials.push_back(material);
  return static_cast<int>(materials.size()) - 1;
}

void Scene::Bounds::grow(const Bounds& b) {
  low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
  high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
}

double Scene::Bounds::area() const {
  const Vec3 d = high - low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

void Scene::ready() {
  std::vector<Bounds> bounds;
  placed_.clear();
  order_.clear();
  for (const Shape& shape : shapes) {
    const Mat3& r = shape.world_from_shape.rotation;
    const Vec3 h = half_extent(shape.solid), c = shape.world_from_shape.t_m;
    const auto reach = [&](int row) {
      return std::abs(r(row, 0)) * h.x + std::abs(r(row, 1)) * h.y + std::abs(r(row, 2)) * h.z;
    };
    const Vec3 half{reach(0), reach(1), reach(2)};
    bounds.push_back({c - half, c + half});
    placed_.push_back({transposed(r), c});
    order_.push_back(static_cast<int>(order_.size()));
  }
  nodes_.assign(1, Node{{}, 0, static_cast<int>(shapes.size()), 0});
  split(0, bounds);
}

// Cuts a node where the boxes of the halves, weighted by what they hold, have the least surface: the fewest are met by rays.
// Source  MacDonald, Booth, "Heuristics for ray tracing using space subdivision", 1990
void Scene::split(int index, const std::vector<Bounds>& bounds) {
  constexpr double kVisit = 1;  // cost of a node in intersections
  const int first = nodes_[index].first, count = nodes_[index].count;
  const auto begin = order_.begin() + first, end = begin + count;
  const auto sort = [&](int axis) {
    const auto key = [&](int i) {
      const Vec3 c = bounds[i].low + bounds[i].high;
      return axis == 0 ? c.x : axis == 1 ? c.y : c.z;
    };
    // Ties by number: the tree, and so which of two coincident surfaces is found, is the same everywhere.
    std::sort(begin, end, [&](int i, int j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
  };
  Bounds& all = nodes_[index].bounds;
  for (auto it = begin; it != end; ++it) all.grow(bounds[*it]);
  if (count < 2) return;

  double best_cost = all.area() * (count - kVisit);
  int best_axis = -1, best_left = 0;
  std::vector<double> right_area(static_cast<std::size_t>(count));
  for (int axis = 0; axis < 3; ++axis) {
    sort(axis);
    Bounds right, left;
    for (int i = count - 1; i > 0; --i) {
      right.grow(bounds[begin[i]]);
      right_area[i] = right.area();
    }
    for (int i = 1; i < count; ++i) {
      left.grow(bounds[begin[i - 1]]);
      const double cost = left.area() * i + right_area[i] * (count - i);
      if (cost < best_cost) best_cost = cost, best_axis = axis, best_left = i;
    }
  }
  if (best_axis < 0) return;
  sort(best_axis);
  const int left = static_cast<int>(nodes_.size());
  nodes_[index] = {nodes_[index].bounds, left, 0, best_axis};
  nodes_.push_back({{}, first, best_left, 0});
  nodes_.push_back({{}, first + best_left, count - best_left, 0});
  split(left, bounds);
  split(left + 1, bounds);
}

// Calls visit(shape) for the shapes whose boxes the ray meets before t_max, near boxes first, until it returns false.
template <class Visit>
void Scene::walk(const Ray& ray, const double& t_max, Visit visit) const {
  DUO_CHECK(!nodes_.empty());
  const Vec3 o = ray.origin, inverse{1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z};
  const auto meets = [&](const Bounds& b) {
    // A ray in the very plane of a face gives 0 * inf = NaN, which min and max in this order pass over.
    double in = 0, out = t_max;
    const auto cut = [&](double low, double high, double origin, double inv) {
      const double a = (low - origin) * inv, c = (high - origin) * inv;
      in = std::max(in, std::min(a, c));
      out = std::min(out, std::max(a, c));
    };
    cut(b.low.x, b.high.x, o.x, inverse.x);
    cut(b.low.y, b.high.y, o.y, inverse.y);
    cut(b.low.z, b.high.z, o.z, inverse.z);
    return in <= out;
  };
  std::array<int, 64> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!meets(node.bounds)) continue;
    if (node.count > 0 || nodes_.size() == 1) {
      for (int i = node.first; i < node.first + node.count; ++i)
        if (!visit(order_[i])) return;
      continue;
    }
    const double along = node.axis == 0 ? ray.direction.x : node.axis == 1 ? ray.direction.y : ray.direction.z;
    stack[depth++] = node.first + (along > 0 ? 1 : 0);
    stack[depth++] = node.first + (along > 0 ? 0 : 1);
  }
}

Ray Scene::to_shape(const Ray& ray, int shape) const {
  const Placed& p = placed_[shape];
  return {p.shape_from_world * (ray.origin - p.centre_m), p.shape_from_world * ray.direction};
}

Hit Scene::trace(const Ray& ray) const {
  Hit hit;
  walk(ray, hit.t, [&](int shape) {
    const double t = trace(ray, shape);
    if (t < hit.t) hit = {shape, t};
    return true;
  });
  return hit;
}

double Scene::trace(const Ray& ray, int shape) const { return intersect(shapes[shape].solid, to_shape(ray, shape), 0); }

bool Scene::blocked(const Ray& ray) const {
  bool found = false;
  const double t_max = 1;
  walk(ray, t_max, [&](int shape) {
    found = shapes[shape].casts_shadow && blocks(shapes[shape].solid, to_shape(ray, shape));
    return !found;
  });
  return found;
}

Vec3 Scene::normal(int shape, Vec3 p_in_world) const {
  const Vec3 p = placed_[shape].shape_from_world * (p_in_world - placed_[shape].centre_m);
  return shapes[shape].world_from_shape.rotation * normal_at(shapes[shape].solid, p);
}

}  // namespace duo::synthetic
