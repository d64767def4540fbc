// Included by C++ and by GLSL.
#ifndef DUO_KEEP_CONFIDENCE_PARAMS_H
#define DUO_KEEP_CONFIDENCE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct KeepConfidencePush {
  Plane d_q4, confidence;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
