#include "calib/row_offsets.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calib/lens_left_over.h"
#include "calib/normal_equations.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr int kTerms = 7;
constexpr std::size_t kLeastPoints = 24;
constexpr double kWorthIt_px = 0.1;  // less is not worth the resampling
constexpr double kBeside_px = 1;     // so far beyond the picture its last row goes on
using Terms = Eigen::Matrix<double, kTerms, 1>;

struct RowDifference {
  Terms terms;
  double px = 0;
};

Terms terms_at(double x_px, double y_px, Size size) {
  const double u = 2 * x_px / (size.width - 1) - 1, v = 2 * y_px / (size.height - 1) - 1;
  const double y = v * size.height / size.width;  // in the units of u, for a lens's circles
  Terms out;
  out << 1, u, v, u * u, u * v, v * v, v * (u * u + y * y);
  return out;
}

/// The differences that lie within `reach_px` of where they lie closest together: wrong matches lie anywhere.
std::vector<RowDifference> densest(std::vector<RowDifference> all, double reach_px) {
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.px < b.px; });
  std::size_t begin = 0, end = 0;
  for (std::size_t i = 0, j = 0; j < all.size(); ++j) {
    while (all[j].px - all[i].px > 2 * reach_px) ++i;
    if (j + 1 - i > end - begin) begin = i, end = j + 1;
  }
  return {all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end)};
}

std::vector<double> off_px(const std::vector<RowDifference>& all, const Terms& fit) {
  std::vector<double> out;
  for (const RowDifference& one : all) out.push_back(std::abs(one.px - one.terms.dot(fit)));
  return out;
}

/// The scale of what a good match may be off: robust, but not below what matches reach.
double scale_px(std::vector<double> off) { return std::max(1.5 * median(off), 0.1); }

Terms fit_terms(const std::vector<RowDifference>& all, int width_px) {
  constexpr int kRounds = 12;
  // How far a nudged or ill calibrated pair may go, px: anywhere; tilted or zoomed; bent; undistorted as another lens.
  Terms prior_px;
  prior_px << 100, 6, 6, 2, 2, 2, width_px / 32.0;
  constexpr double kShared_px = 2;  // neighbours are wrong together: points count for less than their number
  Terms fit = Terms::Zero();
  fit[0] = median([&] {
    std::vector<double> px;
    for (const RowDifference& one : all) px.push_back(one.px);
    return px;
  }());
  for (int round = 0; round < kRounds; ++round) {
    const auto off = off_px(all, fit);
    const double scale = scale_px(off), variance = scale * scale + kShared_px * kShared_px;
    Eigen::Matrix<double, kTerms, kTerms> normal = prior_px.cwiseAbs2().cwiseInverse().asDiagonal();
    Terms right = Terms::Zero();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double weight = 1 / (1 + off[i] * off[i] / (4 * scale * scale)) / variance;
      normal += weight * all[i].terms * all[i].terms.transpose();
      right += weight * all[i].px * all[i].terms;
    }
    fit = solve_normal(normal, right);
  }
  return fit;
}

/// As many points lie close, and as close.
bool explains_as_well(const std::vector<double>& errors_px, const std::vector<double>& others_px) {
  constexpr double kClose_px = 1, kFinest_px = 0.05;
  const auto close = [](const std::vector<double>& all) {
    std::vector<double> out;
    for (const double e : all)
      if (std::abs(e) < kClose_px) out.push_back(std::abs(e));
    return out;
  };
  const auto a = close(errors_px), b = close(others_px);
  if (a.empty() || 100 * a.size() < 99 * b.size()) return false;
  return b.empty() || median(std::vector(a)) <= 1.25 * std::max(median(std::vector(b)), kFinest_px);
}

/// The lens in place of the terms, and what rows are off by it.
void take_lens(const LensLeftOver& lens, const SceneMatches& scene, const std::vector<double>& errors, RowOffsets& out) {
  std::vector<double> off, before, after;
  for (const double e : errors) off.push_back(std::abs(e));
  const double farthest_px = 3 * scale_px(off);
  for (std::size_t i = 0; i < off.size(); ++i) {
    if (off[i] > farthest_px) continue;
    const double px = scene.matches[i].right_px.y - scene.matches[i].left_px.y;
    before.push_back(std::abs(px));
    after.push_back(off[i]);
    out.least_px = before.size() == 1 ? px : std::min(out.least_px, px);
    out.most_px = before.size() == 1 ? px : std::max(out.most_px, px);
  }
  out.lens = lens;
  out.points = static_cast<int>(before.size());
  out.before_px = median(before);
  out.after_px = median(after);
}

}  // namespace

double RowOffsets::at(double x_px, double y_px) const {
  const double px = terms_at(x_px, y_px, size).dot(Terms::Map(terms_px.data()));
  return std::clamp(px, least_px, most_px);
}

bool RowOffsets::matter() const {
  return points >= static_cast<int>(kLeastPoints) && before_px >= kWorthIt_px && after_px < 0.75 * before_px;
}

double row_reach_px(int height) { return std::max(3.0, 0.01 * height); }

RowOffsets fit_row_offsets(const SceneMatches& scene) {
  RowOffsets out;
  out.size = scene.size;
  std::vector<RowDifference> all;
  for (const SceneMatch& match : scene.matches)
    all.push_back({terms_at(match.right_px.x, match.left_px.y, scene.size), match.right_px.y - match.left_px.y});
  all = densest(std::move(all), row_reach_px(scene.size.height));
  if (all.size() < kLeastPoints) return out;
  const Terms fit = fit_terms(all, scene.size.width);
  const auto off = off_px(all, fit);
  const double farthest_px = 3 * scale_px(off);
  std::vector<double> before, after, seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (off[i] > farthest_px) continue;
    before.push_back(std::abs(all[i].px));
    after.push_back(off[i]);
    seen.push_back(all[i].terms.dot(fit));
  }
  std::copy_n(fit.data(), kTerms, out.terms_px.begin());
  const auto [least, most] = std::minmax_element(seen.begin(), seen.end());
  out.least_px = *least;
  out.most_px = *most;
  out.points = static_cast<int>(before.size());
  out.before_px = median(before);
  out.after_px = median(after);
  if (const auto lens = fit_lens_left_over(scene)) {
    std::vector<double> by_terms;
    for (const SceneMatch& m : scene.matches)
      by_terms.push_back(m.right_px.y - m.left_px.y - terms_at(m.right_px.x, m.left_px.y, scene.size).dot(fit));
    const std::vector<double> by_lens = lens_row_errors_px(*lens, scene);
    if (explains_as_well(by_lens, by_terms)) take_lens(*lens, scene, by_lens, out);
  }
  return out;
}

Result<RowOffsets> find_row_offsets(PairSource& pairs, int threads) {
  constexpr std::int64_t kTenSeconds = 300;  // who waits for the first frame waits for this
  DUO_TRY_ASSIGN(const SceneMatches scene, match_scene(pairs, threads, kTenSeconds));
  return fit_row_offsets(scene);
}

RowOffsets find_row_offsets(const Pair& pair, int threads) { return fit_row_offsets(match_pair(pair, threads)); }

Rectification row_maps(const RowOffsets& rows) {
  Rectification out;
  const auto [w, h] = rows.size;
  out.geometry.size = rows.size;
  using Columns = ResampleMap::Columns;
  out.left = {Image<std::uint32_t>(rows.size), Image<std::uint16_t>(rows.size), Columns::kSoft};
  out.right = {Image<std::uint32_t>(rows.size), Image<std::uint16_t>(rows.size), Columns::kCubic};
  LensPlaces places(rows);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      // A row just beyond the picture is taken as its last one: that costs less than a row that nobody may look at, at every
      // coarser level twice as many.
      const Vec2 place = rows.lens ? places.at(x, y) : Vec2{double(x), y + rows.at(x, y)};
      const double row = place.y, last = h - 1;
      const bool beside = row >= -kBeside_px && row <= last + kBeside_px;
      put_place(out.right, y, x, {place.x, beside ? std::clamp(row, 0.0, last) : row}, rows.size);
      put_place(out.left, y, x, {double(x), double(y)}, rows.size);
      // The left picture stays where it is, and is blurred like the right one there.
      const std::uint32_t column = out.left.corner.at(y, x) & 0xFFFF0000;
      const auto across = static_cast<std::uint16_t>(out.left.fraction_q8.at(y, x) & 0xFF00);
      const bool seen = out.right.corner.at(y, x) != ResampleMap::kOutside;
      out.left.corner.at(y, x) = column | static_cast<std::uint32_t>(y);
      out.left.fraction_q8.at(y, x) = across | static_cast<std::uint16_t>(seen ? out.right.fraction_q8.at(y, x) & 0xFF : 0);
    }
  return out;
}

}  // namespace duo
