// Included by C++ and by GLSL.
#ifndef DUO_BILATERAL_PARAMS_H
#define DUO_BILATERAL_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct BilateralPush {
  Plane src, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
