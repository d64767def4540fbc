// Any bytes as two rig files: a pair of ROS camera_info, or OpenCV's intrinsics and extrinsics, parted by the first line of
// dashes.
#include <cstdint>
#include <string_view>

#include "tests/fuzz/accepted_rig.h"

int fuzz_ros(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find("---\n"), size);
  const auto rig = duo::rig_from_two_texts(text.substr(0, end), text.substr(std::min(end + 4, size)), "left", "right");
  if (rig && duo::check_rig(rig->rig, "fuzz")) duo::fuzz::check_accepted(rig->rig);
  return 0;
}
