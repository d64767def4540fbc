// Any bytes as a Kalibr camchain; what is accepted survives being written as one and read again.
#include <cstdint>
#include <string_view>

#include "tests/fuzz/accepted_rig.h"

int fuzz_kalibr(const std::uint8_t* data, std::size_t size) {
  const auto rig = duo::parse_rig({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!rig) return 0;
  duo::fuzz::check_accepted(*rig);
  const auto& [left, right] = std::pair(rig->left.distortion, rig->right.distortion);
  const auto again = duo::parse_rig(
      duo::kalibr_from_rig(*rig, {{{left[0], left[1], left[2], left[3]}, {right[0], right[1], right[2], right[3]}}}), "again");
  DUO_CHECK(again && again->left == rig->left && again->right == rig->right && again->right_from_left == rig->right_from_left);
  return 0;
}
