// Included by C++ and by GLSL.
#ifndef DUO_RECTIFY_PARAMS_H
#define DUO_RECTIFY_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct RectifyPush {
  Plane src, corner, fraction, dst, inside;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
