// Included by C++ and by GLSL.
#ifndef DUO_SPECKLE_PARAMS_H
#define DUO_SPECKLE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kSpeckleRun = 128;  // pixels of a row that a workgroup joins to runs

struct SpecklePush {
  Plane d_q4;
  int width, height;
  int step_q4, smallest;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
