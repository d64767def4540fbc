// Points and rigid motions. Axes of every camera: x right, y down, z forward; metres, radians.
#pragma once

#include <array>
#include <cmath>

namespace [[gnu::visibility("default")]] duo {

struct Vec2 {
  double x = 0, y = 0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

struct Vec3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalized(Vec3 a) { return (1.0 / norm(a)) * a; }

/// 3x3 matrix, row by row.
struct Mat3 {
  std::array<double, 9> m = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double operator()(int row, int column) const { return m[static_cast<std::size_t>(row * 3 + column)]; }
  double& operator()(int row, int column) { return m[static_cast<std::size_t>(row * 3 + column)]; }
  static Mat3 from_rows(Vec3 a, Vec3 b, Vec3 c) { return {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}}; }
  friend bool operator==(const Mat3&, const Mat3&) = default;
};

inline Vec3 operator*(const Mat3& a, Vec3 v) {
  return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
          a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  Mat3 c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  return c;
}
inline Mat3 transposed(const Mat3& a) { return {{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}}; }
inline double determinant(const Mat3& a) {
  return dot({a.m[0], a.m[1], a.m[2]}, cross({a.m[3], a.m[4], a.m[5]}, {a.m[6], a.m[7], a.m[8]}));
}

/// A rigid motion: `p_in_b = b_from_a * p_in_a`. Name values `target_from_source`.
struct Rigid3 {
  Mat3 rotation;
  Vec3 t_m;
  friend bool operator==(const Rigid3&, const Rigid3&) = default;
};

inline Vec3 operator*(const Rigid3& b_from_a, Vec3 p_in_a) { return b_from_a.rotation * p_in_a + b_from_a.t_m; }
inline Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
  return {c_from_b.rotation * b_from_a.rotation, c_from_b * b_from_a.t_m};
}
inline Rigid3 inverse(const Rigid3& b_from_a) {
  const Mat3 r = transposed(b_from_a.rotation);
  return {r, -1.0 * (r * b_from_a.t_m)};
}

}  // namespace duo
