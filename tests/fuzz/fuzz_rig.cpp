// Any bytes as a rig file: our JSON, OpenCV's JSON and YAML, and whatever else load_rig() tells apart.
#include <cstdint>
#include <string_view>

#include "tests/fuzz/accepted_rig.h"

int fuzz_rig(const std::uint8_t* data, std::size_t size) {
  const auto rig = duo::parse_rig({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (rig) duo::fuzz::check_accepted(*rig);
  return 0;
}
