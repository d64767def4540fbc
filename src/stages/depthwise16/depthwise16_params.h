// Included by C++ and by GLSL.
#ifndef DUO_DEPTHWISE16_PARAMS_H
#define DUO_DEPTHWISE16_PARAMS_H
#include "vulkan/plane.h"
#include "vulkan/value_lanes.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct Depthwise16Push {
  Plane x, y;
  int at;  // the packed layer's first word
  int channels, window, stride, pad_top, pad_left;
  int x_width, x_height, y_width, count;  // count: values of a picture of y
  int low, high;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
