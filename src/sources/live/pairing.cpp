#include "sources/live/pairing.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace duo {
namespace {

// A little more than half: cameras that run half a frame apart would else lose every other picture to what is left of the
// jitter.
constexpr double kLimitFrames = 0.53;
// Pictures of one camera that may wait for the other: it delivers at most some frames later, or is away.
constexpr std::size_t kMostWaiting = 4;

}  // namespace

Pairing::Pairing(double frame_s) : limit_ns_(std::llround(kLimitFrames * frame_s * 1e9)) {}

bool Pairing::add(CameraSide side, Picture& picture, Pair& into) {
  auto& waiting = waiting_[static_cast<std::size_t>(side)];
  waiting.push_back(std::move(picture));
  const bool made = match(into);
  if (waiting.size() > kMostWaiting) {
    release(std::move(waiting.front()));
    waiting.pop_front();
    ++lonely_;
  }
  picture = {};
  if (!free_.empty()) {
    picture = std::move(free_.back());
    free_.pop_back();
  }
  return made;
}

bool Pairing::match(Pair& into) {
  auto& [lefts, rights] = waiting_;
  while (!lefts.empty() && !rights.empty()) {
    const TimeNs skew_ns = rights.front().t_ns - lefts.front().t_ns;
    if (std::abs(skew_ns) > limit_ns_) {
      auto& earlier = skew_ns > 0 ? lefts : rights;
      release(std::move(earlier.front()));
      earlier.pop_front();
      ++lonely_;
      continue;
    }
    std::swap(into.left, lefts.front());
    std::swap(into.right, rights.front());
    into.sequence = made_++;
    for (auto* waiting : {&lefts, &rights}) {
      release(std::move(waiting->front()));
      waiting->pop_front();
    }
    return true;  // the picture that came is used: no other pair can be made
  }
  return false;
}

}  // namespace duo
