// Included by C++ and by GLSL.
#ifndef DUO_HISTOGRAM_PARAMS_H
#define DUO_HISTOGRAM_PARAMS_H
#include "vulkan/area.h"
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kHistogramBins = 1024;

struct HistogramPush {
  Plane hue, saturation, value, marks;
  int width, height;
  int with_marks;  // 0 or 1
  int min_value;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
