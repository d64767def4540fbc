// Least squares over points in space: residuals that depend on a few of them, added one by one.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "duoptic/geometry.h"

namespace duo::body {

/// How a residual changes with one point.
struct Slope {
  std::size_t point = 0;
  Vec3 d;
};

/// H x = -g for the step that lowers the sum of squares. Sums run in the order of add(), so that equal inputs give equal bits.
template <std::size_t kPoints>
class PointEquations {
 public:
  static constexpr std::size_t kUnknowns = 3 * kPoints;

  void clear() {
    h_ = {};
    g_ = {};
  }
  /// A residual that was divided by its standard deviation, as its slopes were; `weight` 0 .. 1 of a robust one.
  void add(double residual, std::span<const Slope> slopes, double weight = 1) {
    for (const Slope& a : slopes) {
      const std::array<double, 3> da = {a.d.x, a.d.y, a.d.z};
      for (std::size_t i = 0; i < 3; ++i) g_[3 * a.point + i] += weight * da[i] * residual;
      for (const Slope& b : slopes) {
        const std::array<double, 3> db = {b.d.x, b.d.y, b.d.z};
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j) h_[3 * a.point + i][3 * b.point + j] += weight * da[i] * db[j];
      }
    }
  }
  /// False where the equations leave a point open.
  bool factor() {
    for (std::size_t j = 0; j < kUnknowns; ++j) {
      for (std::size_t i = j; i < kUnknowns; ++i) {
        double sum = h_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= h_[i][k] * h_[j][k];
        if (i > j)
          h_[i][j] = sum / h_[j][j];
        else if (sum > 1e-9)
          h_[j][j] = std::sqrt(sum);
        else
          return false;
      }
    }
    return true;
  }
  /// After factor(): how far to move each point.
  std::array<Vec3, kPoints> step() const {
    std::array<double, kUnknowns> x;
    for (std::size_t i = 0; i < kUnknowns; ++i) x[i] = -g_[i];
    solve(x);
    std::array<Vec3, kPoints> out;
    for (std::size_t p = 0; p < kPoints; ++p) out[p] = {x[3 * p], x[3 * p + 1], x[3 * p + 2]};
    return out;
  }
  /// After factor(): the covariance of one point, all others free. Order xx xy xz yy yz zz.
  std::array<double, 6> covariance(std::size_t point) const {
    std::array<std::array<double, 3>, 3> c;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<double, kUnknowns> x = {};
      x[3 * point + axis] = 1;
      solve(x);
      for (std::size_t i = 0; i < 3; ++i) c[axis][i] = x[3 * point + i];
    }
    return {c[0][0], c[0][1], c[0][2], c[1][1], c[1][2], c[2][2]};
  }

 private:
  void solve(std::array<double, kUnknowns>& x) const {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= h_[i][k] * x[k];
      x[i] /= h_[i][i];
    }
    for (std::size_t i = kUnknowns; i-- > 0;) {
      for (std::size_t k = i + 1; k < kUnknowns; ++k) x[i] -= h_[k][i] * x[k];
      x[i] /= h_[i][i];
    }
  }

  std::array<std::array<double, kUnknowns>, kUnknowns> h_ = {};  // factor() replaces its lower half by L, H = L L^T
  std::array<double, kUnknowns> g_ = {};
};

}  // namespace duo::body
