#include "calib/moved_points.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calib/normal_equations.h"
#include "calib/scene_pose.h"
#include "core/pool.h"
#include "stages/gray/gray.h"

namespace duo {
namespace {

/// A match that no pose explains, and how far it lies off its row.
struct OffRow {
  SceneMatch match;
  double px = 0;
};

bool same_match(const SceneMatch& a, const SceneMatch& b) {
  return a.left_px.x == b.left_px.x && a.left_px.y == b.left_px.y && a.right_px.x == b.right_px.x &&
         a.right_px.y == b.right_px.y;
}

/// Of the scene's matches, in their order, those that are not among the agreeing ones.
std::vector<SceneMatch> others_of(const SceneMatches& scene, const std::vector<SceneMatch>& agreeing) {
  std::vector<SceneMatch> out;
  auto next = agreeing.begin();
  for (const SceneMatch& match : scene.matches)
    if (next != agreeing.end() && same_match(match, *next))
      ++next;
    else
      out.push_back(match);
  return out;
}

std::vector<double> off_rows_px(const std::optional<Rig>& rig, const std::vector<SceneMatch>& agreeing,
                                const std::vector<SceneMatch>& matches) {
  if (rig) return row_errors_px(*rig, matches);
  const auto down_px = [](const SceneMatch& m) { return m.right_px.y - m.left_px.y; };
  const MatchPlane plane = plane_of(agreeing, down_px);
  std::vector<double> out;
  for (const SceneMatch& m : matches) out.push_back(down_px(m) - plane.at(m.left_px));
  return out;
}

/// How alike two places are, -1 .. 1; 0 near a border, and where nothing is to be seen.
double likeness(const Image<std::uint8_t>& left, int lx, int ly, const Image<std::uint8_t>& right, int rx, int ry) {
  constexpr int kRadius_px = 7;
  const auto inside = [](const Image<std::uint8_t>& in, int x, int y) {
    return x >= kRadius_px && y >= kRadius_px && x < in.width() - kRadius_px && y < in.height() - kRadius_px;
  };
  if (!inside(left, lx, ly) || !inside(right, rx, ry)) return 0;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int dy = -kRadius_px; dy <= kRadius_px; ++dy)
    for (int dx = -kRadius_px; dx <= kRadius_px; ++dx) {
      const double l = left.at(ly + dy, lx + dx), r = right.at(ry + dy, rx + dx);
      a += l, b += r, aa += l * l, bb += r * r, ab += l * r;
    }
  constexpr double kCount = (2 * kRadius_px + 1) * (2 * kRadius_px + 1);
  const double energy = (aa - a * a / kCount) * (bb - b * b / kCount);
  return energy > 0 ? (ab - a * b / kCount) / std::sqrt(energy) : 0;
}

/// Whether most of them look nearly as much alike somewhere on their own row; of many some are asked. Where nothing can be
/// compared, near a border, they are taken to stand nowhere else.
bool stands_on_its_row(const std::vector<OffRow>& group, const Pair& pair) {
  constexpr double kNearly = 0.9, kReachOfWidth = 0.25;
  constexpr int kRows_px = 2;
  constexpr std::size_t kMostAsked = 30;  // each takes milliseconds in large pictures
  Pool pool(1);
  Image<std::uint8_t> left(pair.left.pixels.size()), right(pair.right.pixels.size());
  simd::gray(pool, pair.left.pixels, left);
  simd::gray(pool, pair.right.pixels, right);
  const int reach_px = static_cast<int>(kReachOfWidth * left.width());
  const auto rounded = [](double px) { return static_cast<int>(std::lround(px)); };
  const auto stands = [&](const OffRow& o) {
    const int lx = rounded(o.match.left_px.x), ly = rounded(o.match.left_px.y), rx = rounded(o.match.right_px.x),
              ry = rounded(o.match.right_px.y), on_row = rounded(o.match.right_px.y - o.px);
    double there = 0, here = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) there = std::max(there, likeness(left, lx, ly, right, rx + dx, ry + dy));
    for (int y = on_row - kRows_px; y <= on_row + kRows_px; ++y)
      for (int x = rx - reach_px; x <= rx + reach_px; ++x) here = std::max(here, likeness(left, lx, ly, right, x, y));
    return there > 0 && here > kNearly * there;
  };
  const std::size_t asked = std::min(group.size(), kMostAsked);
  std::size_t standing = 0;
  for (std::size_t i = 0; i < asked; ++i) standing += stands(group[i * group.size() / asked]);
  return 2 * standing > asked;
}

}  // namespace

MatchPlane plane_of(const std::vector<SceneMatch>& matches, double (*value)(const SceneMatch&)) {
  const auto count = static_cast<Eigen::Index>(matches.size());
  Eigen::MatrixXd terms(count, 3);
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SceneMatch& m = matches[static_cast<std::size_t>(i)];
    terms.row(i) << 1, m.left_px.x, m.left_px.y;
    values[i] = value(m);
  }
  const Eigen::VectorXd plane = solve_normal(terms.transpose() * terms, terms.transpose() * values);
  return {plane[0], plane[1], plane[2]};
}

std::string why_moved(const std::optional<Rig>& rig, const SceneMatches& scene, const std::vector<SceneMatch>& agreeing,
                      const Pair& pair) {
  constexpr double kLeast_px = 4, kLeastOfWidth = 0.008;  // off its row: more than any rig that is nearly right
  constexpr double kNearOfWidth = 0.125, kSame_px = 1.5, kSame = 0.2;
  constexpr double kApart_px = 3;  // one place gives several points
  constexpr std::size_t kFewest = 6;
  constexpr double kShare = 0.03;  // of all points
  const double width = scene.size.width, least_px = std::max(kLeast_px, kLeastOfWidth * width);
  const std::vector<SceneMatch> others = others_of(scene, agreeing);
  const std::vector<double> off_px = off_rows_px(rig, agreeing, others);
  std::vector<OffRow> off;
  for (std::size_t i = 0; i < others.size(); ++i)
    if (std::abs(off_px[i]) >= least_px) off.push_back({others[i], off_px[i]});
  const auto disparity_px = [](const OffRow& o) { return o.match.left_px.x - o.match.right_px.x; };
  const auto alike = [&](const OffRow& a, const OffRow& b) {
    const double same_px = std::max(kSame_px, kSame * std::abs(a.px));
    return std::abs(a.match.left_px.x - b.match.left_px.x) < kNearOfWidth * width &&
           std::abs(a.match.left_px.y - b.match.left_px.y) < kNearOfWidth * width && std::abs(a.px - b.px) < same_px &&
           std::abs(disparity_px(a) - disparity_px(b)) < 2 * same_px;
  };
  std::vector<OffRow> most;
  for (const OffRow& one : off) {
    std::vector<OffRow> group;
    for (const OffRow& other : off) {
      const auto is_near = [&](const OffRow& in) {
        return std::hypot(in.match.left_px.x - other.match.left_px.x, in.match.left_px.y - other.match.left_px.y) < kApart_px;
      };
      if (alike(one, other) && std::none_of(group.begin(), group.end(), is_near)) group.push_back(other);
    }
    if (group.size() > most.size()) most = std::move(group);
  }
  if (most.size() < kFewest || static_cast<double>(most.size()) < kShare * static_cast<double>(scene.matches.size())) return {};
  if (stands_on_its_row(most, pair)) return {};
  Vec2 middle{};
  double sum_px = 0;
  for (const OffRow& o : most) middle.x += o.match.left_px.x, middle.y += o.match.left_px.y, sum_px += o.px;
  const auto count = static_cast<double>(most.size());
  return fmt::format(
      "something moved between the two pictures: around ({:.0f}, {:.0f}) {} points lie {:.0f} px off their rows, and depth is "
      "wrong there and wherever else it moved; take both at one moment",
      middle.x / count, middle.y / count, most.size(), std::abs(sum_px) / count);
}

}  // namespace duo
