// Included by C++ and by GLSL: parts of a picture as kernels read them, because they change from frame to frame.
#ifndef DUO_VULKAN_AREA_H
#define DUO_VULKAN_AREA_H
#ifdef __cplusplus
#include "core/area.h"
namespace duo::vk {
#endif

// duo::Area in whole words, without its marks, which are fixed when a kernel is recorded. All zero = no pixel.
struct DeviceArea {
  int x, y, x_end, y_end;
  int disc_x, disc_y, radius_px;
  int bits;
};

// Invocations of one workgroup, and workgroups an area, of kernels that go through areas of any size.
const int kAreaLanes = 128;
const int kAreaGroups = 32;

#ifdef __cplusplus

inline DeviceArea device_area(const Area& area) {
  const auto& [window, disc, marks, bits] = area;
  return {window.x, window.y, window.x_end(), window.y_end(), disc.x, disc.y, disc.radius_px, bits};
}

}  // namespace duo::vk
#else

// The columns [x, z) of rows [y, w) that hold all of it in a picture of this size.
ivec4 bounds_of(DeviceArea area, ivec2 size) {
  ivec2 from = max(ivec2(area.x, area.y), ivec2(0)), end = min(ivec2(area.x_end, area.y_end), size);
  if (area.radius_px >= 0) {
    const ivec2 centre = ivec2(area.disc_x, area.disc_y);
    from = max(from, centre - area.radius_px);
    end = min(end, centre + area.radius_px + 1);
  }
  return ivec4(from, max(end, from));
}

// Whether a place inside its bounds lies in its disc.
bool in_disc(DeviceArea area, ivec2 at) {
  const ivec2 from = at - ivec2(area.disc_x, area.disc_y);
  return area.radius_px < 0 || from.x * from.x + from.y * from.y <= area.radius_px * area.radius_px;
}

#endif
#endif
