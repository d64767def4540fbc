// OpenCV's stereo matchers, run beside ours on the same pictures. For comparison alone.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "duoptic/image.h"

namespace [[gnu::visibility("default")]] duo {

/// One matcher with one set of parameters.
struct Peer {
  enum class Kind { kBm, kSgbm, k3Way, kHh4, kHh };
  const char* name;
  Kind kind;
  int block, cap, uniqueness, speckle;
  int p1 = 0, p2 = 0;   // SGBM family
  int texture = 0;      // BM
  bool padded = false;  // the pictures are widened to the left, so that OpenCV does not lose its first columns
};

/// For accuracy: the usual parameters, and those that a grid search found best on tsukuba, venus, teddy and cones.
std::span<const Peer> accuracy_peers();
/// For speed: StereoBM and the semi-global modes 3WAY, HH4 and HH with the usual parameters.
std::span<const Peer> speed_peers();

/// A peer made ready for one pair, so that run() is the matching call alone.
class PeerMatcher {
 public:
  /// Searches [0, max_disparity) rounded up to a multiple of 16, as OpenCV asks for.
  PeerMatcher(const Peer& peer, View<const std::uint8_t> left, View<const std::uint8_t> right, int max_disparity);
  PeerMatcher(PeerMatcher&&) noexcept;
  ~PeerMatcher();
  void run(int threads);
  /// What the last run() found: px, negative = none.
  Image<float> disparity_px() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Gray as OpenCV converts it.
Image<std::uint8_t> opencv_gray(View<const Rgb8> color);

std::string opencv_version();

}  // namespace duo
