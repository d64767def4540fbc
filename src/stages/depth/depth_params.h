// Included by C++ and by GLSL.
#ifndef DUO_DEPTH_PARAMS_H
#define DUO_DEPTH_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct DepthPush {
  Plane src, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
