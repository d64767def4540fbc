// Included by C++ and by GLSL.
#ifndef DUO_GAUSSIAN_PARAMS_H
#define DUO_GAUSSIAN_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct GaussianPush {
  Plane src, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
