#include "evaluation/light_code.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "duoptic/statistics.h"

namespace duo {
namespace {

// Cosine of the eighths of a turn in 1/2^14; the sine is the cosine two eighths before.
constexpr std::array<std::int32_t, kPhaseSteps> kCosine = {16384, 11585, 0, -11585, -16384, -11585, 0, 11585};
constexpr std::int32_t cosine(int eighths) { return kCosine[static_cast<std::size_t>(eighths & 7)]; }
constexpr double kTurn = 6.283185307179586;

/// A harmonic of eight steps: sums of whole numbers, exact.
struct Harmonic {
  double cosine = 0, sine = 0;
  double squared() const { return cosine * cosine + sine * sine; }
};

Harmonic harmonic(std::span<const std::uint16_t> steps, int number) {
  Harmonic out;
  for (int k = 0; k < kPhaseSteps; ++k) {
    const int turned = number * eighths_of_step(k);
    out.cosine += steps[static_cast<std::size_t>(k)] * cosine(turned);
    out.sine += steps[static_cast<std::size_t>(k)] * cosine(turned - 2);
  }
  return out;
}

bool has_saturated(std::span<const std::uint16_t> steps) {
  return std::find(steps.begin(), steps.end(), kSaturated) != steps.end();
}

/// The stripe in halves of its width, so that the border between two is a whole number, too; none where bits are in doubt.
/// One bit may be: then the stripes with it and without must lie side by side, and the place is at their border.
std::optional<int> stripe_centre_q1(std::span<const std::uint16_t> bits, int least) {
  std::uint32_t gray = 0, doubtful = 0;
  int doubts = 0;
  for (std::size_t i = 0; i < bits.size(); i += 2) {
    const bool ends = bits[i] == kSaturated && bits[i + 1] == kSaturated;
    const int difference = int{bits[i]} - int{bits[i + 1]};
    const bool weak = ends || std::abs(difference) < least;
    gray = gray << 1 | static_cast<std::uint32_t>(difference > 0);
    doubtful = doubtful << 1 | static_cast<std::uint32_t>(weak);
    doubts += weak;
  }
  const int one = static_cast<int>(number_of_gray(gray));
  if (doubts == 0) return 2 * one + 1;
  const int other = static_cast<int>(number_of_gray(gray ^ doubtful));
  if (doubts > 1 || std::abs(one - other) != 1) return std::nullopt;
  return 2 * std::max(one, other);
}

}  // namespace

PlaceOnAxis place_on_axis(std::span<const std::uint16_t> samples, int period_px, int length_px, double noise) {
  const auto bits = samples.first(samples.size() - kPhaseSteps), steps = samples.last(kPhaseSteps);
  if (has_saturated(steps)) return {LightState::kSaturated};
  const Harmonic first = harmonic(steps, 1);
  const double amplitude = std::sqrt(first.squared()) / (16384.0 * kPhaseSteps / 2);
  PlaceOnAxis out{LightState::kUnlit, -1, static_cast<int>(amplitude)};
  if (amplitude < 6 * noise) return out;
  out.state = LightState::kUncertain;
  // Black and white differ by twice the amplitude.
  const auto centre_q1 = stripe_centre_q1(bits, std::max(static_cast<int>(4 * noise), out.amplitude / 2));
  if (!centre_q1) return out;
  const double turns = std::atan2(first.sine, first.cosine) / kTurn;
  const auto phase_q16 = static_cast<std::int64_t>(std::llround(turns * 65536)) & 0xFFFF;
  // Of the places with this phase the one nearest to the stripe: within it, and an eighth of a period beside for what blur
  // moves its border.
  const std::int64_t period_q8 = std::int64_t{period_px} * 256, centre_q8 = *centre_q1 * (period_q8 / 4);
  const std::int64_t in_period_q8 = (period_q8 * phase_q16 + 32768) >> 16;
  const auto periods = static_cast<std::int64_t>(
      std::floor(static_cast<double>(centre_q8 - in_period_q8) / static_cast<double>(period_q8) + 0.5));
  const std::int64_t place_q8 = periods * period_q8 + in_period_q8;
  if (std::abs(place_q8 - centre_q8) > period_q8 * 3 / 8 || place_q8 < 0 || place_q8 >= std::int64_t{length_px} * 256)
    return out;
  out.state = LightState::kKnown;
  out.place_q8 = static_cast<std::int32_t>(place_q8);
  return out;
}

std::optional<double> noise_variance(std::span<const std::uint16_t> steps) {
  if (has_saturated(steps)) return std::nullopt;
  // By Parseval: the third harmonic counts twice, for it stands for the fifth, too; three degrees of freedom.
  const double squares = (2 * harmonic(steps, 3).squared() + harmonic(steps, 4).squared()) / kPhaseSteps;
  return squares / (16384.0 * 16384.0) / 3;
}

std::optional<RowMatch> find_on_row(const PlacePlanes& other, int y, int x_begin, int x_end, std::int32_t x_q8,
                                    std::int32_t y_q8, std::int32_t reach_q8) {
  const std::int32_t *const xs = other.at.x_q8.row(y), *const ys = other.at.y_q8.row(y);
  const std::int32_t *const x_steps = other.step.x_q8.row(y), *const y_steps = other.step.y_q8.row(y);
  std::optional<RowMatch> best;
  std::int32_t nearest = reach_q8 + 1;
  for (int x = std::max(x_begin, 0); x < std::min(x_end, other.at.x_q8.width()); ++x) {
    const std::int32_t apart = x_q8 - xs[x], step = x_steps[x];
    // Half a pixel to each side, and a twentieth more, so that nothing is lost between two.
    if (xs[x] < 0 || step == 0 || 20 * std::abs(apart) > 11 * std::abs(step)) continue;
    if (std::abs(step) > reach_q8 || std::abs(y_steps[x]) > reach_q8) continue;
    const double share = double(apart) / double(step);
    const auto row_q8 = static_cast<std::int32_t>(std::lround(ys[x] + share * y_steps[x]));
    if (std::abs(row_q8 - y_q8) >= nearest) continue;
    nearest = std::abs(row_q8 - y_q8);
    best = RowMatch{x, x + share, row_q8};
  }
  return best;
}

namespace {

/// Twice how much the projector's row changes to the row below; 0 where it is not known.
std::int32_t two_rows_q8(const ViewPlaces& view, int y, int x, std::int32_t reach_q8) {
  if (y == 0 || y + 1 == view.y_q8.height()) return 0;
  const std::int32_t above = view.y_q8.at(y - 1, x), below = view.y_q8.at(y + 1, x);
  return above < 0 || below < 0 || std::abs(below - above) > 2 * reach_q8 ? 0 : below - above;
}

}  // namespace

ViewMatch match_views(Pool& pool, const PlacePlanes& left, const PlacePlanes& right, const LightCode& code) {
  // Where a pixel of a camera is wider than a quarter of a period the sine cannot be seen.
  const std::int32_t reach_q8 = code.period_px * 256 / 4;
  const Size size = left.at.x_q8.size();
  ViewMatch out{Image<float>(size)};
  struct RowCounts {
    std::int64_t matched = 0, contradicting = 0;
    std::vector<float> rows_px;
  };
  std::vector<RowCounts> counts(static_cast<std::size_t>(size.height));
  pool.rows(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      RowCounts& of_row = counts[static_cast<std::size_t>(y)];
      for (int x = 0; x < size.width; ++x) {
        const std::int32_t x_q8 = left.at.x_q8.at(y, x), y_q8 = left.at.y_q8.at(y, x);
        if (x_q8 < 0) continue;
        const auto match = find_on_row(right, y, x - LightTruth::kMostDisparity_px, x + 1, x_q8, y_q8, reach_q8);
        if (!match || !(match->x_px < x)) continue;
        const int at = match->column;
        const auto back = find_on_row(left, y, at, at + LightTruth::kMostDisparity_px + 1, right.at.x_q8.at(y, at),
                                      right.at.y_q8.at(y, at), reach_q8);
        constexpr double kAgree_px = 1;
        if (!back || std::abs((back->x_px - at) - (x - match->x_px)) > kAgree_px) {
          ++of_row.contradicting;
          continue;
        }
        ++of_row.matched;
        out.disparity_px.at(y, x) = static_cast<float>(x - match->x_px);
        if (const std::int32_t two_rows = two_rows_q8(left.at, y, x, reach_q8); two_rows != 0)
          of_row.rows_px.push_back(2 * static_cast<float>(y_q8 - match->y_q8) / static_cast<float>(two_rows));
      }
    }
  });
  std::vector<float> rows_px;
  for (const RowCounts& of_row : counts) {
    out.matched += of_row.matched;
    out.contradicting += of_row.contradicting;
    rows_px.insert(rows_px.end(), of_row.rows_px.begin(), of_row.rows_px.end());
  }
  if (!rows_px.empty()) out.rows_px = median(rows_px);
  return out;
}

}  // namespace duo
