// Included by C++ and by GLSL.
#ifndef DUO_WEIGHTED_MEDIAN_PARAMS_H
#define DUO_WEIGHTED_MEDIAN_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct WeightedMedianPush {
  Plane d_q4, guide, origin, dst;
  int width, height;
  int only_filled;  // 0 or 1: there is an origin picture
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
