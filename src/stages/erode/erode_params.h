// Included by C++ and by GLSL.
#ifndef DUO_ERODE_PARAMS_H
#define DUO_ERODE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct ErodePush {
  Plane src, dst;
  int width, height;
  int diagonal;  // 0 or 1: all eight neighbours
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
