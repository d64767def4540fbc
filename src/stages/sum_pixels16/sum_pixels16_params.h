// Included by C++ and by GLSL.
#ifndef DUO_SUM_PIXELS16_PARAMS_H
#define DUO_SUM_PIXELS16_PARAMS_H
#include "vulkan/plane.h"
#include "vulkan/value_lanes.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct SumPixels16Push {
  Plane x, y;
  int channels, y_width, y_height;
  int pixels, shift;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
