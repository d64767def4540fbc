#include "clicks.h"

#include <fmt/format.h>

namespace duo::app::view {

std::string Clicks::prompt() const {
  const std::size_t next = clicks_.size();
  const bool right = arms_ == Arms::kBoth ? next < kArmJoints : arms_ == Arms::kRight;
  return fmt::format("Click the {} {} ({} of {})", right ? "right" : "left", name(next), next + 1, needed());
}

std::vector<ArmSelection> Clicks::selections() const {
  std::vector<ArmSelection> arms(clicks_.size() / kArmJoints);
  for (std::size_t i = 0; i < arms.size() * kArmJoints; ++i) arms[i / kArmJoints].clicks[i % kArmJoints] = clicks_[i];
  return arms;
}

}  // namespace duo::app::view
