// Included by C++ and by GLSL.
#ifndef DUO_WEIGHTED_MEDIAN_PARAMS_H
#define DUO_WEIGHTED_MEDIAN_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct WeightedMedianPush {
  Plane d_q4, guide, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
