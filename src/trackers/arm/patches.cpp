#include "trackers/arm/patches.h"

#include <algorithm>
#include <cmath>

namespace duo::arm {
namespace {

constexpr double kLeastScore = 0.5;
constexpr float kLeastContrast = 2.5F;  // levels, one standard deviation: below it is noise
constexpr int kMostReach = 10;
constexpr int kFineReach = 3;

/// A square of the picture, resampled so that the patch has its first size in it. Row by row, side x side, bilinear;
/// the picture continues by its edge pixels.
template <int Side>
struct Square {
  static constexpr int kMostSide = Side;
  std::array<float, Side * Side> values;
  int side = 0;

  void sample(const GrayLevel& gray, Vec2 centre_px, double scale, int radius) {
    side = 2 * radius + 1;
    float* out = values.data();
    for (int j = 0; j < side; ++j) {
      const double y = std::clamp(centre_px.y + (j - radius) * scale, 0.0, gray.height - 1.001);
      const int v = static_cast<int>(y);
      const auto b = static_cast<float>(y - v);
      for (int i = 0; i < side; ++i) {
        const double x = std::clamp(centre_px.x + (i - radius) * scale, 0.0, gray.width - 1.001);
        const int u = static_cast<int>(x);
        const auto a = static_cast<float>(x - u);
        const std::uint8_t *p = gray.at(u, v), *q = p + gray.width;
        const float top = static_cast<float>(p[0]) + a * static_cast<float>(p[1] - p[0]);
        const float bottom = static_cast<float>(q[0]) + a * static_cast<float>(q[1] - q[0]);
        *out++ = top + b * (bottom - top);
      }
    }
  }
};

template <int R>
bool cut(const GrayLevel& gray, Vec2 at_px, PatchPixels<R>& out) {
  if (!(at_px.x >= R && at_px.y >= R && at_px.x < gray.width - R - 1 && at_px.y < gray.height - R - 1)) return false;
  Square<2 * R + 1> square;
  square.sample(gray, at_px, 1, R);
  float sum = 0, squares = 0;
  for (const float v : square.values) sum += v;
  const float n = static_cast<float>(square.values.size()), mean = sum / n;
  for (const float v : square.values) squares += (v - mean) * (v - mean);
  if (!(squares >= kLeastContrast * kLeastContrast * n)) return false;
  const float length = std::sqrt(squares);
  for (std::size_t i = 0; i < square.values.size(); ++i) out.values[i] = (square.values[i] - mean) / length;
  return true;
}

/// Sums down the columns of a square that the parts of it beginning in one row share.
template <int R, int Side>
struct Columns {
  std::array<float, Side> sums, squares;

  Columns(const Square<Side>& square, int y) {
    std::fill_n(sums.begin(), square.side, 0.0F);
    std::fill_n(squares.begin(), square.side, 0.0F);
    for (int j = 0; j < PatchPixels<R>::kSide; ++j) {
      const float* s = square.values.data() + (y + j) * square.side;
      for (int i = 0; i < square.side; ++i) {
        sums[static_cast<std::size_t>(i)] += s[i];
        squares[static_cast<std::size_t>(i)] += s[i] * s[i];
      }
    }
  }
};

/// Correlation of the patch with the part of the square whose upper left corner is (x, y).
template <int R, int Side>
double correlation(const PatchPixels<R>& patch, const Square<Side>& square, const Columns<R, Side>& columns, int x, int y) {
  constexpr int kSide = PatchPixels<R>::kSide;
  float dots[kSide] = {};  // by column: independent, so that they fill vectors
  for (int j = 0; j < kSide; ++j) {
    const float* s = square.values.data() + (y + j) * square.side + x;
    const float* p = patch.values.data() + j * kSide;
    for (int i = 0; i < kSide; ++i) dots[i] += s[i] * p[i];
  }
  float dot = 0, sum = 0, squares = 0;
  for (int i = 0; i < kSide; ++i) {
    dot += dots[i];
    sum += columns.sums[static_cast<std::size_t>(x + i)];
    squares += columns.squares[static_cast<std::size_t>(x + i)];
  }
  constexpr float n = kSide * kSide;
  const float spread = squares - sum * sum / n;
  return spread >= kLeastContrast * kLeastContrast * n ? dot / std::sqrt(spread) : -1;
}

/// Where between -0.5 and 0.5 the parabola through three scores peaks.
double peak(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < -1e-9 && before > -1 && after > -1 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

}  // namespace

std::optional<Patch> cut_patch(const GrayLevels& gray, Vec2 at_px) {
  Patch out;
  if (!cut(gray.full, at_px, out.full) || !cut(gray.half, in_blocks(at_px, 2), out.half)) return {};
  return out;
}

std::optional<PatchMatch> find_patch(const GrayLevels& gray, const Patch& patch, Vec2 near_px, double scale, int reach) {
  reach = std::min(reach, kMostReach);
  constexpr double kNear = 0.002;  // a pixel further away must be better by this
  Square<2 * (kMostReach + 4) + 1> coarse;
  coarse.sample(gray.half, in_blocks(near_px, 2), scale, reach + patch.half.kRadius);
  double best = -2;
  Vec2 step;
  for (int j = -reach; j <= reach; ++j) {
    const Columns<4, decltype(coarse)::kMostSide> columns(coarse, j + reach);
    for (int i = -reach; i <= reach; ++i) {
      const double score = correlation(patch.half, coarse, columns, i + reach, j + reach) - kNear * std::sqrt(i * i + j * j);
      if (score <= best) continue;
      best = score;
      step = {static_cast<double>(i), static_cast<double>(j)};
    }
  }
  if (best < kLeastScore) return {};

  const Vec2 centre = {near_px.x + 2 * scale * step.x, near_px.y + 2 * scale * step.y};
  Square<2 * (kFineReach + 6) + 1> fine;
  fine.sample(gray.full, centre, scale, kFineReach + patch.full.kRadius);
  constexpr int kScores = 2 * kFineReach + 1;
  std::array<std::array<double, kScores>, kScores> scores;
  std::size_t x = 1, y = 1;
  for (std::size_t j = 0; j < kScores; ++j) {
    const Columns<6, decltype(fine)::kMostSide> columns(fine, static_cast<int>(j));
    for (std::size_t i = 0; i < kScores; ++i) {
      scores[j][i] = correlation(patch.full, fine, columns, static_cast<int>(i), static_cast<int>(j));
      const bool inner = i > 0 && j > 0 && i + 1 < kScores && j + 1 < kScores;
      if (inner && scores[j][i] > scores[y][x]) x = i, y = j;
    }
  }
  if (scores[y][x] < kLeastScore) return {};
  const double dx = static_cast<double>(x) - kFineReach + peak(scores[y][x - 1], scores[y][x], scores[y][x + 1]);
  const double dy = static_cast<double>(y) - kFineReach + peak(scores[y - 1][x], scores[y][x], scores[y + 1][x]);
  return PatchMatch{{centre.x + scale * dx, centre.y + scale * dy}, scores[y][x]};
}

double corner_strength(const GrayLevel& gray, int x, int y) {
  int xx = 0, xy = 0, yy = 0;
  for (int v = y - 3; v <= y + 3; ++v)
    for (int u = x - 3; u <= x + 3; ++u) {
      const std::uint8_t* p = gray.at(u, v);
      const int gx = p[1] - p[-1], gy = p[gray.width] - p[-gray.width];
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  const double half_difference = (xx - yy) / 2.0;
  return (xx + yy) / 2.0 - std::sqrt(half_difference * half_difference + static_cast<double>(xy) * xy);
}

}  // namespace duo::arm
