#include "detectors/fixed.h"

#include <algorithm>
#include <array>

namespace duo {
namespace {

constexpr int kSigmoidEnd = 16 * 128;

/// e^x for 0 <= x <= 16 by e^(x/16)^16, in double precision, made by the compiler: a library's exp may differ from machine to
/// machine.
constexpr double exponential(double x) {
  double term = 1, sum = 1;
  for (int i = 1; i < 30; ++i) sum += term *= x / 16 / i;
  for (int i = 0; i < 4; ++i) sum *= sum;
  return sum;
}

constexpr auto kSigmoid = [] {
  std::array<std::uint16_t, kSigmoidEnd + 1> out = {};
  for (int i = 0; i <= kSigmoidEnd; ++i) {
    const double e = exponential(i / 128.0);
    out[i] = static_cast<std::uint16_t>(32768 * e / (1 + e) + 0.5);
  }
  return out;
}();

}  // namespace

std::uint16_t sigmoid_q15(std::int32_t x_q7) {
  const int at = std::min(x_q7 < 0 ? -std::max(x_q7, -kSigmoidEnd) : x_q7, kSigmoidEnd);
  return x_q7 < 0 ? static_cast<std::uint16_t>(32768 - kSigmoid[at]) : kSigmoid[at];
}

}  // namespace duo
