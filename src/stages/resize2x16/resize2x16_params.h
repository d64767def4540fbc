// Included by C++ and by GLSL.
#ifndef DUO_RESIZE2X16_PARAMS_H
#define DUO_RESIZE2X16_PARAMS_H
#include "vulkan/plane.h"
#include "vulkan/value_lanes.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct Resize2x16Push {
  Plane x, y;
  int channels, y_width, y_height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
