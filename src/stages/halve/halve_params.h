// Included by C++ and by GLSL.
#ifndef DUO_HALVE_PARAMS_H
#define DUO_HALVE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct HalvePush {
  Plane src, dst;
  int width, height;  // of src
  int all;            // 0: mean of four; 1: their AND
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
