// A detector that knows: for tests of what is built on detectors.
#pragma once

#include <span>
#include <vector>

#include "duoptic/detector.h"

namespace duo {

/// What a person's points are in the next picture.
struct TrueBody {
  std::array<SeenPoint, kBodyPoints> points = {};
  std::optional<std::array<SeenPoint, kHandPoints>> left_hand, right_hand;
};

/// Says where projected points are, with the noise of a network: `noise_px` wide at the scale of a region of 256 px, the same
/// in every run. Looks at no pixel: show() says what the next calls are asked about.
class TruthDetector final : public Detector {
 public:
  explicit TruthDetector(double noise_px) : noise_px_(noise_px) {}
  void show(std::span<const TrueBody> bodies);

  std::span<const FoundPerson> find(View<const Rgb8> picture, Window part) override;
  /// The person whose hips are nearest to the region's centre; no score when no one's are within half of it.
  void bodies(std::span<const Look> looks, std::span<SeenBody> out) override;
  void hands(std::span<const Look> looks, std::span<SeenHand> out) override;
  bool sees_hands() const override { return true; }

 private:
  void add_noise(SeenPoint& point, const TurnedSquare& region, std::size_t number) const;

  double noise_px_;
  std::uint64_t picture_ = 0;
  std::vector<TrueBody> bodies_;
  std::vector<FoundPerson> found_;
};

}  // namespace duo
