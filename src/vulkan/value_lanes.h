// Included by C++ and by GLSL.
#ifndef DUO_VULKAN_VALUE_LANES_H
#define DUO_VULKAN_VALUE_LANES_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// Workgroup of kernels with one invocation a value, and one workgroup row a picture.
const int kValueLanes = 128;

struct ValuesPush {
  Plane x, y;
  int channels, y_width, y_height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
