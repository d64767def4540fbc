// Included by C++ and by GLSL.
#ifndef DUO_DEPTH_TO_SPACE16_PARAMS_H
#define DUO_DEPTH_TO_SPACE16_PARAMS_H
#include "vulkan/plane.h"
#include "vulkan/value_lanes.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct DepthToSpace16Push {
  Plane x, y;
  int channels, y_width, y_height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
