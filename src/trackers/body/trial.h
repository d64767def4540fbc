// Whether somebody new is a person.
#pragma once

#include <optional>

namespace duo::body {

/// Judges somebody new by its first frames: a person shows most of the joints that are marked on it, and stands out of what is
/// beside.
class Trial {
 public:
  /// What one frame says. `share`: of the joints that it can show, how many are seen; none where it cannot show the person.
  /// `ticks`: from one frame to the next at the nominal rate: frames that were left out show nothing.
  void add(std::optional<double> share, bool is_flat, double ticks);
  /// Whether enough was seen to call its joints seen.
  bool is_believed() const { return shown_.ticks >= kBelieve; }
  /// Whether it is a person, and needs no more frames.
  bool is_over() const { return shown_.ticks >= kConfirm; }
  bool is_mistake() const { return poor_.ticks >= kMostPoor || flat_.ticks >= kMostFlat; }

 private:
  // Ticks after the first frame, so that at any rate a second frame agrees with it.
  static constexpr double kBelieve = 2, kConfirm = 9, kMostFlat = 3, kMostPoor = 1;
  /// How long frames have shown something, from the first one on.
  struct Shown {
    double ticks = -1;  // less than 0: not yet
    void add(double more) { ticks = ticks < 0 ? 0 : ticks + more; }
  };
  // Enough of the joints; of these frames, those in which it does not stand out; too few, in frames in a row.
  Shown shown_, flat_, poor_;
};

}  // namespace duo::body
