// Included by C++ and by GLSL.
#ifndef DUO_MEDIAN_PARAMS_H
#define DUO_MEDIAN_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct MedianPush {
  Plane src, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
