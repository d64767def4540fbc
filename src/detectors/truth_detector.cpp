#include "detectors/truth_detector.h"

#include <algorithm>
#include <limits>

#include "detectors/place.h"

namespace duo {
namespace {

/// The middle of two points.
PointQ8 middle(const SeenPoint& a, const SeenPoint& b) { return {(a.x_q8 + b.x_q8) / 2, (a.y_q8 + b.y_q8) / 2}; }

PointQ8 hips_of(const TrueBody& body) {
  return middle(body.points[static_cast<std::size_t>(BodyPoint::kLeftHip)],
                body.points[static_cast<std::size_t>(BodyPoint::kRightHip)]);
}

/// The circle around a standing person has its centre at the hips and a radius of 1.9 torsos.
TurnedSquare around(const std::array<SeenPoint, kBodyPoints>& points, PointQ8 hips) {
  const PointQ8 shoulders = middle(points[static_cast<std::size_t>(BodyPoint::kLeftShoulder)],
                                   points[static_cast<std::size_t>(BodyPoint::kRightShoulder)]);
  return region_around(hips, {hips.x + (shoulders.x - hips.x) * 19 / 10, hips.y + (shoulders.y - hips.y) * 19 / 10});
}

std::int64_t square_distance(const TurnedSquare& region, PointQ8 point) {
  const std::int64_t x = std::int64_t{point.x} - region.x_q8, y = std::int64_t{point.y} - region.y_q8;
  return x * x + y * y;
}

/// A number from -1 to 1 in 1/1024 that looks like chance: three words of splitmix64 make its middle likelier.
std::int64_t chance(std::uint64_t seed) {
  std::int64_t sum = 0;
  for (int i = 0; i < 3; ++i) {
    std::uint64_t z = (seed += 0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    sum += static_cast<std::int64_t>((z ^ (z >> 31)) & 2047) - 1024;
  }
  return sum / 3;
}

}  // namespace

void TruthDetector::show(std::span<const TrueBody> bodies) {
  bodies_.assign(bodies.begin(), bodies.end());
  ++picture_;
}

void TruthDetector::add_noise(SeenPoint& point, const TurnedSquare& region, std::size_t number) const {
  const auto noise_q8 = static_cast<std::int64_t>(noise_px_ * 256);
  const auto shift = [&](std::uint64_t axis) {  // 3 standard deviations reach from -1 to 1
    const std::int64_t q8 = 3 * noise_q8 * chance(picture_ * 1000003 + number * 2 + axis) / 1024;
    return static_cast<std::int32_t>(q8 * half_side(region) / (128 * 256));
  };
  point.x_q8 += shift(0);
  point.y_q8 += shift(1);
}

std::span<const FoundPerson> TruthDetector::find(View<const Rgb8>, Window part) {
  found_.clear();
  for (const TrueBody& body : bodies_) {
    const PointQ8 hips = hips_of(body);
    const TurnedSquare region = around(body.points, hips);
    const bool inside = part.contains(hips.y >> 8, hips.x >> 8);
    if (inside && 7 * half_side(region) >= std::max(part.width, part.height) * 128) found_.push_back({region, 32767});
  }
  return found_;
}

void TruthDetector::bodies(std::span<const Look> looks, std::span<SeenBody> out) {
  for (std::size_t i = 0; i < looks.size(); ++i) {
    out[i] = {};
    const TurnedSquare& region = looks[i].region;
    const std::int64_t half = half_side(region);
    const auto nearest =
        std::ranges::min_element(bodies_, {}, [&](const TrueBody& body) { return square_distance(region, hips_of(body)); });
    if (nearest == bodies_.end() || square_distance(region, hips_of(*nearest)) > half * half) continue;
    out[i].score_q15 = 32767;
    out[i].points = nearest->points;
    for (std::size_t k = 0; k < kBodyPoints; ++k)
      add_noise(out[i].points[k], region, static_cast<std::size_t>(nearest - bodies_.begin()) * 100 + k);
    out[i].next = around(nearest->points, hips_of(*nearest));
  }
}

void TruthDetector::hands(std::span<const Look> looks, std::span<SeenHand> out) {
  for (std::size_t i = 0; i < looks.size(); ++i) {
    out[i] = {};
    const TurnedSquare& region = looks[i].region;
    std::int64_t least = std::int64_t{half_side(region)} * half_side(region);
    std::size_t number = 0;
    for (const TrueBody& body : bodies_)
      for (const bool right : {false, true}) {
        number += kHandPoints;
        const auto& hand = right ? body.right_hand : body.left_hand;
        if (!hand) continue;
        const std::int64_t distance = square_distance(region, {(*hand)[9].x_q8, (*hand)[9].y_q8});  // the middle knuckle
        if (distance >= least) continue;
        least = distance;
        out[i].score_q15 = 32767;
        out[i].right_q15 = right ? 32767 : 0;
        out[i].points = *hand;
        for (std::size_t k = 0; k < kHandPoints; ++k) add_noise(out[i].points[k], region, number + k);
      }
  }
}

}  // namespace duo
