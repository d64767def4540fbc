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
  /// Whether somebody with the middle of the trunk there was a mistake. Where furniture stands, people may still be found.
  bool was_mistaken(Vec3 trunk) const;
  void add_mistake(Vec3 trunk);

 private:
  struct Place {
    Vec3 at;
    std::int64_t until = 0;  // calls
  };
  /// The latest ones.
  struct Places {
    std::array<Place, 16> all;
    std::size_t next = 0;
    void add(Vec3 at, std::int64_t until);
  };
  bool was_refused(Vec3 at) const;

  Uprights uprights_;
  Places things_, mistakes_;
  std::int64_t call_ = 0;
};

}  // namespace duo::body
