// Areas on a device, for the tests of what looks at areas.
#pragma once

#include "tests/areas.h"
#include "tests/records_vk.h"
#include "vulkan/area.h"

namespace duo::test {

/// As many random areas as there is room for, written where the next upload takes them from; `masked` by the marks.
inline std::vector<Area> put_random_areas(std::mt19937& rng, Size size, const Image<std::uint8_t>& marks, bool masked,
                                          const Records<vk::DeviceArea>& into) {
  std::vector<Area> areas(into.count());
  std::vector<vk::DeviceArea> words;
  for (Area& area : areas) {
    area = random_area(rng, size, marks);
    area.marks = masked ? marks.view() : View<const std::uint8_t>();
    words.push_back(vk::device_area(area));
  }
  std::memcpy(into.bytes().data(), words.data(), words.size() * sizeof(words[0]));
  return areas;
}

}  // namespace duo::test
