// Included by C++ and by GLSL.
#ifndef DUO_MARK_TARGETS_PARAMS_H
#define DUO_MARK_TARGETS_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// duo::Target in whole words; all zero = an empty window.
struct MarkTarget {
  int hue, hue_tolerance, min_saturation, min_value;
  int x, y, x_end, y_end;
};

const int kMarkTargets = 6;

struct MarkTargetsPush {
  Plane hue, saturation, value, marks;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
