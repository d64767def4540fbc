// Which joint is to be clicked next, and what was clicked.
#pragma once

#include <string>
#include <vector>

#include "duoptic/tracker.h"

namespace [[gnu::visibility("default")]] duo {

/// The joints of one skeleton after the other, each from the ends of its limbs to its root.
class Clicks {
 public:
  /// What can be selected: each of the tracker's skeletons, and where there are two of them both.
  ///
  /// `wanted`: whether they are asked for at once.
  Clicks(std::vector<const Skeleton*> skeletons, bool wanted);
  /// "right", "left", "both".
  const std::vector<std::string>& choices() const { return choices_; }
  std::size_t choice() const { return choice_; }

  void start(std::size_t choice);
  void stop() { wanted_ = false; }
  bool wanted() const { return wanted_; }
  const std::vector<Click>& made() const { return clicks_; }
  /// Whether a bone joins the click to the one before.
  bool joined(std::size_t click) const;

  /// True when it was the last one.
  bool add(double x_px, double y_px);
  void undo() {
    if (!clicks_.empty()) clicks_.pop_back();
  }

  /// "Click the right hand (1 of 3)".
  std::string prompt() const;
  /// Without its side: "hand".
  std::string name(std::size_t click) const { return std::string(part_of(asked_[click]->id)); }
  std::vector<Selection> selections() const;

 private:
  std::vector<const Skeleton*> skeletons_;
  std::vector<std::string> choices_;
  std::size_t choice_ = 0;
  std::vector<const JointDef*> asked_;  // for choice_
  std::vector<Click> clicks_;           // of the first of asked_
  bool wanted_ = true;
};

}  // namespace duo
