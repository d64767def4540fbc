// A frame that waits for a sink.
#pragma once

#include <vector>

#include "duoptic/sink.h"

namespace duo {

/// A TrackedFrame that waits. Without pictures it holds none, so that the engine has its frames back.
struct KeptFrame {
  TrackedFrame frame;
  std::vector<Person> people;
  Picture left;  // capture time and number alone
  Frame light;

  void keep(const TrackedFrame& from, bool pictures) {
    frame = from;
    people.assign(from.people.begin(), from.people.end());
    if (pictures) return;
    left.t_ns = from.left->t_ns;
    left.sequence = from.left->sequence;
    light.sequence = from.frame->sequence;
    light.t_ns = from.frame->t_ns;
    light.skew_ns = from.frame->skew_ns;
    frame.left = nullptr;
    frame.frame = nullptr;
  }
  /// As long as this is not moved.
  TrackedFrame view() const {
    TrackedFrame out = frame;
    out.people = people;
    if (out.left == nullptr) out.left = {std::shared_ptr<const Picture>(), &left};
    if (out.frame == nullptr) out.frame = {std::shared_ptr<const Frame>(), &light};
    return out;
  }
};

}  // namespace duo
