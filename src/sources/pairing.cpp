#include "sources/pairing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "duoptic/statistics.h"

namespace duo {
namespace {

// Of the faster camera's time from picture to picture. A little more than half: cameras that run half a picture apart would
// else lose every other one to what is left of the jitter.
constexpr double kLimit = 0.53;
// As far may a pair like the one before it be apart.
constexpr double kLimitOfLike = 0.6, kLike = 0.2;
constexpr double kNearer = 0.25;
// Pictures of one camera that may wait for the other: it delivers at most some pictures later, or is away.
constexpr std::size_t kMostWaiting = 4;
// A live source's first picture may be old: it told the size.
constexpr std::int64_t kEnoughSteps = 3;

}  // namespace

Pairing::Pairing(std::array<double, 2> frame_s) {
  for (std::size_t i = 0; i < 2; ++i) cameras_[i].frame_ns = frame_s[i] * 1e9;
}

void Pairing::put(CameraSide side, Picture& picture) {
  Camera& camera = cameras_[index(side)];
  if (camera.put > 0) {
    const auto steps = static_cast<std::int64_t>(camera.steps_ns.size());
    camera.steps_ns[static_cast<std::size_t>((camera.put - 1) % steps)] = std::max<TimeNs>(picture.t_ns - camera.last_ns, 0);
    if (camera.put >= kEnoughSteps) {
      std::array<TimeNs, 9> sorted = camera.steps_ns;
      const auto middle = median(std::span(sorted).first(static_cast<std::size_t>(std::min(camera.put, steps))));
      if (middle > 0) camera.frame_ns = static_cast<double>(middle);
    }
  }
  camera.last_ns = picture.t_ns;
  ++camera.put;
  camera.waiting.push_back(std::move(picture));
  picture = {};
  if (!free_.empty()) {
    picture = std::move(free_.back());
    free_.pop_back();
  }
}

bool Pairing::complete(CameraSide side, std::size_t i, Picture& picture) {
  Picture& waiting = cameras_[index(side)].waiting[i];
  if (waiting.t_ns != picture.t_ns) return false;
  std::swap(waiting, picture);
  return true;
}

Pairing::Step Pairing::leave_out(Camera& camera) {
  release(std::move(camera.waiting.front()));
  camera.waiting.pop_front();
  ++camera.alone;
  return Step::kAlone;
}

Pairing::Step Pairing::step(Pair& into) {
  auto& [left, right] = cameras_;
  if (left.waiting.empty() || right.waiting.empty()) {
    for (Camera& camera : cameras_)
      if (camera.waiting.size() > kMostWaiting) return leave_out(camera);
    return Step::kMore;
  }
  const auto t_ns = [](const Camera& camera, std::size_t i) { return static_cast<double>(camera.waiting[i].t_ns); };
  const double skew_ns = t_ns(right, 0) - t_ns(left, 0), frame_ns = std::min(left.frame_ns, right.frame_ns);
  Camera &earlier = skew_ns > 0 ? left : right, &later = skew_ns > 0 ? right : left;
  const bool like = made_ > 0 && std::abs(skew_ns - last_skew_ns_) < kLike * frame_ns;
  if (std::abs(skew_ns) > (like ? kLimitOfLike : kLimit) * frame_ns) return leave_out(earlier);
  if (earlier.waiting.size() > 1) {
    const double nearer_ns = std::abs(skew_ns) - std::abs(t_ns(earlier, 1) - t_ns(later, 0));
    if (nearer_ns > kNearer * frame_ns) return leave_out(earlier);
  }
  last_skew_ns_ = skew_ns;
  std::swap(into.left, left.waiting.front());
  std::swap(into.right, right.waiting.front());
  into.sequence = made_++;
  for (Camera& camera : cameras_) {
    release(std::move(camera.waiting.front()));
    camera.waiting.pop_front();
  }
  return Step::kPair;
}

}  // namespace duo
