// Included by C++ and by GLSL.
#ifndef DUO_FILL_PARAMS_H
#define DUO_FILL_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct FillPush {
  Plane d_q4, origin;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
