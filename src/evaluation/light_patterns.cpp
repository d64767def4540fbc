#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "duoptic/structured_light.h"
#include "evaluation/light_code.h"

namespace duo {
namespace {

constexpr int kLeastScreen_px = 16, kMostScreen_px = 16384, kLeastPeriod_px = 8, kMostPeriod_px = 256;

/// The sine of one period at its pixels' centres, step 0; 0 .. 1.
double sine_at(double pixel, int period_px, int step) {
  constexpr double kTurn = 6.283185307179586;
  return 0.5 + 0.5 * std::cos(kTurn * ((pixel + 0.5) / period_px - turns_of_step(step)));
}

/// The pattern along the axis that it codes.
std::uint8_t value_at(const LightCode& code, const LightPattern& pattern, int pixel, int bits, int white) {
  switch (pattern.kind) {
    case LightPattern::Kind::kLight:
      return 0;
    case LightPattern::Kind::kStripes:
    case LightPattern::Kind::kInverse: {
      const std::uint32_t gray = gray_of(static_cast<std::uint32_t>(pixel / (code.period_px / 2)));
      const bool lit = (gray >> (bits - 1 - pattern.number) & 1) != 0;
      return static_cast<std::uint8_t>(lit != (pattern.kind == LightPattern::Kind::kInverse) ? white : 0);
    }
    case LightPattern::Kind::kSine:
      return static_cast<std::uint8_t>(std::lround(white * sine_at(pixel, code.period_px, pattern.number)));
  }
  return 0;
}

}  // namespace

Result<void> check_light_code(const LightCode& code) {
  const auto refused = [](const std::string& why) { return Error{ErrorCode::kBadInput, "cannot use these patterns: " + why}; };
  for (const int side : {code.screen.width, code.screen.height})
    if (side < kLeastScreen_px || side > kMostScreen_px)
      return refused(fmt::format("a screen of {}x{}; each side must have {} to {} px", code.screen.width, code.screen.height,
                                 kLeastScreen_px, kMostScreen_px));
  if (code.period_px % 2 != 0 || code.period_px < kLeastPeriod_px || code.period_px > kMostPeriod_px)
    return refused(fmt::format("a period of {} px; it must be an even number from {} to {}", code.period_px, kLeastPeriod_px,
                               kMostPeriod_px));
  return {};
}

int gray_bits(const LightCode& code, bool rows) {
  const int stripe = code.period_px / 2, length = rows ? code.screen.height : code.screen.width;
  int bits = 1;
  while (stripe << bits < length) ++bits;
  return bits;
}

std::vector<LightPattern> light_patterns(const LightCode& code) {
  std::vector<LightPattern> out = {{}};
  for (const bool rows : {false, true}) {
    for (int bit = 0; bit < gray_bits(code, rows); ++bit)
      for (const auto kind : {LightPattern::Kind::kStripes, LightPattern::Kind::kInverse}) out.push_back({kind, rows, bit});
    for (int step = 0; step < kPhaseSteps; ++step) out.push_back({LightPattern::Kind::kSine, rows, step});
  }
  return out;
}

std::string describe_pattern(const LightCode& code, const LightPattern& pattern) {
  const char* what = pattern.rows ? "rows" : "columns";
  switch (pattern.kind) {
    case LightPattern::Kind::kLight:
      return "black, in ordinary light";
    case LightPattern::Kind::kStripes:
    case LightPattern::Kind::kInverse:
      return fmt::format("stripes {} of {} of {}{}", pattern.number + 1, gray_bits(code, pattern.rows), what,
                         pattern.kind == LightPattern::Kind::kInverse ? ", inverse" : "");
    case LightPattern::Kind::kSine:
      return fmt::format("sine {} of {} of {}", pattern.number + 1, kPhaseSteps, what);
  }
  return {};
}

Image<std::uint8_t> draw_pattern(const LightCode& code, const LightPattern& pattern, int white) {
  DUO_CHECK(check_light_code(code).has_value() && white >= 0 && white <= 255);
  Image<std::uint8_t> out(code.screen);
  const int bits = gray_bits(code, pattern.rows);
  if (pattern.rows) {
    for (int y = 0; y < out.height(); ++y) std::fill_n(out.row(y), out.width(), value_at(code, pattern, y, bits, white));
    return out;
  }
  for (int x = 0; x < out.width(); ++x) out.at(0, x) = value_at(code, pattern, x, bits, white);
  for (int y = 1; y < out.height(); ++y) std::copy_n(out.row(0), out.width(), out.row(y));
  return out;
}

}  // namespace duo
