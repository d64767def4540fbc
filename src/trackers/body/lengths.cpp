#include "trackers/body/lengths.h"

#include <algorithm>
#include <numeric>

namespace duo::body {
namespace {

/// Of adults of 1.7 m: sites on the joints' centres.
constexpr std::array<double, kBones> kAdult_m = {0.345, 0.21, 0.465, 0.252, 0.238, 0.068, 0.405, 0.415, 0.16, 0.285, 0.18};
constexpr double kMost = 0.15;        // share by which a length may differ from the prior, scaled
constexpr double kPriorWeight = 6;    // samples that the prior counts as
constexpr double kPriorSigma = 0.08;  // share
constexpr double kLeastSigma_m = 0.004;
constexpr double kLearnt = 50, kWrong_m = 0.008;  // samples of weight 1; of limbs each frame gives two

}  // namespace

Lengths::Lengths() : Lengths(1) {}

Lengths::Lengths(double scale) {
  for (std::size_t b = 0; b < kBones; ++b) prior_m_[b] = length_m_[b] = kept_m_[b] = scale * kAdult_m[b];
}

double Lengths::sigma_m(Bone bone) const {
  const auto b = static_cast<std::size_t>(bone);
  return kLeastSigma_m + kPriorSigma * prior_m_[b] * kPriorWeight / (kPriorWeight + samples_[b].total);
}

void Lengths::learn(Bone bone, double measured_m, double weight) {
  const auto b = static_cast<std::size_t>(bone);
  const double prior = prior_m_[b];
  if (!(weight > 0) || !(measured_m > (1 - 2 * kMost) * prior && measured_m < (1 + 2 * kMost) * prior)) return;
  Samples& s = samples_[b];
  if (s.count == kMostSamples) s.total -= s.weight[s.next];
  s.length_m[s.next] = static_cast<float>(measured_m);
  s.weight[s.next] = static_cast<float>(weight);
  s.total += s.weight[s.next];
  s.next = (s.next + 1) % s.length_m.size();
  s.count = std::min(s.count + 1, s.length_m.size());

  std::array<std::uint16_t, Lengths::kMostSamples> order = {};
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(s.count);
  std::iota(order.begin(), end, std::uint16_t{0});
  std::sort(order.begin(), end, [&](std::uint16_t i, std::uint16_t j) {
    return s.length_m[i] != s.length_m[j] ? s.length_m[i] < s.length_m[j] : i < j;
  });
  double sum = 0;
  std::size_t at = 0;
  while (at + 1 < s.count && 2 * (sum + s.weight[order[at]]) < s.total) sum += s.weight[order[at++]];
  const double learnt = s.length_m[order[at]];
  const double mixed = (s.total * learnt + kPriorWeight * prior) / (s.total + kPriorWeight);
  length_m_[b] = std::clamp(mixed, (1 - kMost) * prior, (1 + kMost) * prior);
  if (s.total < kLearnt || std::abs(length_m_[b] - kept_m_[b]) > kWrong_m) kept_m_[b] = length_m_[b];
}

void Lengths::lengthen(Bone bone, double by_m) {
  const auto b = static_cast<std::size_t>(bone);
  Samples& s = samples_[b];
  for (std::size_t i = 0; i < s.count; ++i) s.length_m[i] += static_cast<float>(by_m);
  const double lengthened = length_m_[b] + by_m * s.total / (s.total + kPriorWeight);
  length_m_[b] = std::clamp(lengthened, (1 - kMost) * prior_m_[b], (1 + kMost) * prior_m_[b]);
}

double HipMark::low_m() const {
  constexpr double kPrior = 6;  // samples that say that nothing is off
  // People differ, too: their ratios by 1 cm of place, marks by 3. Chosen on the four shared clips and synthetic ones of seeds
  // 501 and 502.
  constexpr double kShare = 0.85;
  constexpr double kMost_m = 0.04;
  return std::clamp(kShare * sum_m_ / (total_ + kPrior), -kMost_m, kMost_m);
}

void HipMark::learn(double trunk_m, double thigh_m, double moved_m) {
  constexpr double kRatio = kAdult_m[static_cast<std::size_t>(Bone::kTrunk)] / kAdult_m[static_cast<std::size_t>(Bone::kThigh)];
  constexpr double kMostOff_m = 0.1, kMostTotal = 256;
  const double off_m = (trunk_m - kRatio * thigh_m) / (1 + kRatio) + moved_m;
  sum_m_ += std::clamp(off_m, -kMostOff_m, kMostOff_m);
  ++total_;
  if (total_ > kMostTotal) {
    sum_m_ *= kMostTotal / total_;
    total_ = kMostTotal;
  }
}

}  // namespace duo::body
