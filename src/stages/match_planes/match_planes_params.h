// Included by C++ and by GLSL.
#ifndef DUO_MATCH_PLANES_PARAMS_H
#define DUO_MATCH_PLANES_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// The planes of one view: three words a pixel, one H x W plane above the other. Bytes, the lowest first:
//   word 0: values of the three channels, outside (0 or 255)
//   word 1: their lower bounds, census bits 0 .. 7
//   word 2: their upper bounds, census bits 8 .. 15
const int kMatchPlanes = 3;

struct MatchPlanesPush {
  Plane gray, inside, planes;
  int width, height;
  int masked;  // 0 or 1: there is an inside picture
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
