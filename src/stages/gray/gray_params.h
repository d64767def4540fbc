// Included by C++ and by GLSL.
#ifndef DUO_GRAY_PARAMS_H
#define DUO_GRAY_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct GrayPush {
  Plane src, dst;  // src in pixels of three bytes
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
