// Included by C++ and by GLSL.
#ifndef DUO_MARK_TARGETS_PARAMS_H
#define DUO_MARK_TARGETS_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// duo::Target in whole words; all zero = no pixel fits.
struct MarkTarget {
  int hue, hue_tolerance, min_saturation, min_value;
  int likelihood, min_likelihood;
  int min_q4, max_q4, background_tolerance_q4;
  int pass_unknown;
  int x, y, x_end, y_end;
};

const int kMarkTargets = 6;
const int kMarkBins = 1024;

struct MarkTargetsPush {
  Plane hue, saturation, value, d, background, marks;
  int width, height;
  int with_d, with_background;  // 0 or 1: there is such a picture
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
