#include "trackers/body/trial.h"

namespace duo::body {

void Trial::add(std::optional<double> share, bool is_flat, double ticks) {
  constexpr double kEnough = 1.0 / 3;
  if (!share) return;
  if (*share >= kEnough) {
    shown_.add(ticks);
    if (is_flat) flat_.add(ticks);
    poor_ = {};
  } else {
    poor_.add(ticks);
  }
}

}  // namespace duo::body
