// Included by C++ and by GLSL.
#ifndef DUO_CONV_FIRST16_PARAMS_H
#define DUO_CONV_FIRST16_PARAMS_H
#include "vulkan/plane.h"
#include "vulkan/value_lanes.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct ConvFirst16Push {
  Plane x, y;
  int at;                                                    // the packed layer's first word
  int outputs, pad_top, pad_left, x_width, x_height, count;  // count: values of a picture of y
  int low, high;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
