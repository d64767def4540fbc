// Included by C++ and by GLSL.
#ifndef DUO_LUCAS_KANADE_PARAMS_H
#define DUO_LUCAS_KANADE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct LucasKanadePush {
  Plane left, right, d_q4, dst;
  int width, height, most_q4;  // most_q4: the largest disparity
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
