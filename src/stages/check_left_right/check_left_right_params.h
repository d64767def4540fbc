// Included by C++ and by GLSL.
#ifndef DUO_CHECK_LEFT_RIGHT_PARAMS_H
#define DUO_CHECK_LEFT_RIGHT_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct CheckLeftRightPush {
  Plane left, right, left_inside, right_inside, value, dst;
  int width, height;
  int tolerance, reach;
  int masked;  // 0 or 1: there are inside pictures
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
