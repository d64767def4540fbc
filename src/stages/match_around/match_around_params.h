// Included by C++ and by GLSL.
#ifndef DUO_MATCH_AROUND_PARAMS_H
#define DUO_MATCH_AROUND_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct MatchAroundPush {
  Plane left, right, left_inside, right_inside, coarser, dst;
  int width, height;
  int radius;
  int whole_row;  // 0 or 1: every position of the right row, no coarser level
  int masked;     // 0 or 1: there are inside pictures
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
