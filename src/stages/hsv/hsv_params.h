// Included by C++ and by GLSL.
#ifndef DUO_HSV_PARAMS_H
#define DUO_HSV_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct HsvPush {
  Plane src;  // in pixels of three bytes
  Plane hue, saturation, value;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
