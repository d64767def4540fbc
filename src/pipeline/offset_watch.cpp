#include "pipeline/offset_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace duo {
namespace {

constexpr std::size_t kMostPairs = 900, kFewestPairs = 45;

/// Pearson's. 0 where one of them does not change.
double correlation(std::span<const double> a, std::span<const double> b) {
  const auto n = static_cast<double>(a.size());
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) mean_a += a[i] / n, mean_b += b[i] / n;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double da = a[i] - mean_a, db = b[i] - mean_b;
    aa += da * da, bb += db * db, ab += da * db;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace

void OffsetWatch::see(TimeNs t_ns, const std::array<double, 2>& motion, double least) {
  least_ = least;
  if (motion_[0].size() == kMostPairs) return;
  if (motion_[0].empty()) {
    first_ns_ = t_ns;
    for (auto& side : motion_) side.reserve(kMostPairs);  // no frame after this one allocates
  }
  last_ns_ = t_ns;
  // Roots: a large motion does not outweigh all others.
  for (std::size_t i = 0; i < 2; ++i) motion_[i].push_back(std::sqrt(motion[i]));
}

std::string OffsetWatch::warning() const {
  constexpr double kFits = 0.8, kClearly = 0.3, kFarthest_s = 3;
  constexpr int kLeastShare = 3;       // an overlap of two thirds of the pairs at least
  constexpr std::size_t kFewest = 15;  // pictures of either video in which much moves: a flash of light and single noisy pixels
                                       // fit each other at any offset
  constexpr int kNear = 1;             // pictures: cameras in step are up to half a one apart
  const std::span<const double> left = motion_[0], right = motion_[1];
  const auto pairs = static_cast<int>(left.size());
  if (left.size() < kFewestPairs || last_ns_ <= first_ns_) return {};
  const double frame_s = static_cast<double>(last_ns_ - first_ns_) * 1e-9 / (pairs - 1);
  for (const auto& side : {left, right})
    if (static_cast<std::size_t>(std::ranges::count_if(side, [&](double root) { return root * root >= least_; })) < kFewest)
      return {};
  const int farthest = std::min(pairs / kLeastShare, static_cast<int>(kFarthest_s / frame_s));
  // The right video's picture i shows what the left one's picture i + later does.
  const auto fit = [&](int later) {
    const auto both = static_cast<std::size_t>(pairs - std::abs(later)), of_left = static_cast<std::size_t>(std::max(0, later)),
               of_right = static_cast<std::size_t>(std::max(0, -later));
    return correlation(left.subspan(of_left, both), right.subspan(of_right, both));
  };
  std::vector<double> fits;
  for (int later = -farthest; later <= farthest; ++later) fits.push_back(fit(later));
  const auto best = std::ranges::max_element(fits);
  if (*best < kFits) return {};
  // One peak, beside which all falls: steps and waving fit again a period later, and which of the two it is cannot be told.
  const auto is_close = [&](double other) { return other > *best - kClearly; };
  auto first = best, last = best;
  while (first != fits.begin() && is_close(*std::prev(first))) --first;
  while (std::next(last) != fits.end() && is_close(*std::next(last))) ++last;
  if (std::any_of(fits.begin(), first, is_close) || std::any_of(std::next(last), fits.end(), is_close)) return {};
  const auto offset_of = [&](auto peak) { return static_cast<int>(peak - fits.begin()) - farthest; };
  if (offset_of(first) <= kNear && offset_of(last) >= -kNear) return {};
  const double later_ms = 1000 * offset_of(best) * frame_s;
  return fmt::format(
      "the right video seems to have begun {:.0f} ms {} than the left one, and depth of what moves is wrong: add {:.0f} to "
      "--skew-ms",
      std::abs(later_ms), later_ms > 0 ? "later" : "earlier", later_ms);
}

}  // namespace duo
