// Included by C++ and by GLSL.
#ifndef DUO_ADD16_PARAMS_H
#define DUO_ADD16_PARAMS_H
#include "vulkan/plane.h"
#include "vulkan/value_lanes.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct Add16Push {
  Plane a, b, y;
  int channels, of_b, count;  // of_b: channels of b; count: values of a picture of y
  int left_a, left_b, shift, low, high;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
