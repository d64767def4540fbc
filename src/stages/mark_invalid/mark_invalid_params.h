// Included by C++ and by GLSL.
#ifndef DUO_MARK_INVALID_PARAMS_H
#define DUO_MARK_INVALID_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct MarkInvalidPush {
  Plane winner, left_inside, right_inside, dst;
  int width, height;
  int max_disparity;
  int masked;  // 0 or 1: there are inside pictures
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
