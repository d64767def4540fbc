// Which joint is to be clicked next, and what was clicked.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "duoptic/tracker.h"

namespace duo::app::view {

/// The person's own arms. The tracker does not tell them apart; words and their order do.
enum class Arms : std::uint8_t { kRight, kLeft, kBoth };
inline constexpr std::array<const char*, 3> kArmsNames = {"right", "left", "both"};

/// Hand, elbow and shoulder of one arm, then of the other when both are wanted.
class Clicks {
 public:
  using Click = ArmSelection::Click;

  void start(Arms arms) {
    arms_ = arms;
    clicks_.clear();
    wanted_ = true;
  }
  void stop() { wanted_ = false; }
  bool wanted() const { return wanted_; }
  Arms arms() const { return arms_; }
  const std::vector<Click>& made() const { return clicks_; }

  /// True when it was the last one.
  bool add(Click click) {
    clicks_.push_back(click);
    return clicks_.size() == needed();
  }
  void undo() {
    if (!clicks_.empty()) clicks_.pop_back();
  }

  /// "Click the right hand (1 of 3)".
  std::string prompt() const;
  std::string name(std::size_t click) const { return std::string(kJointNames[click % kArmJoints]); }
  std::vector<ArmSelection> selections() const;

 private:
  std::size_t needed() const { return arms_ == Arms::kBoth ? 2 * kArmJoints : kArmJoints; }
  Arms arms_ = Arms::kRight;
  std::vector<Click> clicks_;
  bool wanted_ = true;
};

}  // namespace duo::app::view
