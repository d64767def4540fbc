// Included by C++ and by GLSL.
#ifndef DUO_SUMS_PARAMS_H
#define DUO_SUMS_PARAMS_H
#include "vulkan/area.h"
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct SumsPush {
  Plane marks, hue, d;
  int width, height;
  int with_marks, with_hue, with_d;  // 0 or 1
  int partial;                       // 1: from pixels to a sum a workgroup; 0: from those to the results
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
