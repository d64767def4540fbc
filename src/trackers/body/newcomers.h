// People whom nobody follows yet, found by depth.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "trackers/body/frame_view.h"
#include "trackers/body/upright.h"

namespace duo::body {

/// Asks the network of bodies about what is upright and is none of those who are tracked. What is no person is left alone for
/// the next five calls.
class Newcomers {
 public:
  /// Looks at one of them, the nearest first. `tracked`: the middles of trunks. Returns where a person is, for the next look.
  std::optional<TurnedSquare> look(Detector& detector, const FrameView& frame, std::span<const Vec3> tracked);
  /// Whether what stands there was no person.
  bool was_refused(Vec3 at) const;
  void refuse(Vec3 at);

 private:
  struct Refused {
    Vec3 at;
    std::int64_t until = 0;  // calls
  };
  Uprights uprights_;
  std::array<Refused, 16> refused_;
  std::size_t next_refused_ = 0;
  std::int64_t call_ = 0;
};

}  // namespace duo::body
