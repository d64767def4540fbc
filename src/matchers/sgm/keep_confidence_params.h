// Included by C++ and by GLSL: what a margin is worth.
#ifndef DUO_KEEP_CONFIDENCE_PARAMS_H
#define DUO_KEEP_CONFIDENCE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo {
#define DUO_INLINE inline
#else
#define DUO_INLINE
#endif

const int kConfidenceReach = 3;         // columns and rows around a pixel in which its disparity may change
const int kConfidenceMostStep_q4 = 48;  // what changes more counts as this

// Of a margin of 0 .. 255 where disparities differ by step_q4 >= 0 around: a half at one pixel, a quarter at three, 1 at least.
DUO_INLINE int confidence_of(int margin, int step_q4) {
  const int confidence = 16 * margin / (16 + (step_q4 < kConfidenceMostStep_q4 ? step_q4 : kConfidenceMostStep_q4));
  return confidence > 1 ? confidence : 1;
}

#undef DUO_INLINE
#ifdef __cplusplus
namespace vk {
#endif

struct KeepConfidencePush {
  Plane d_q4, confidence;
  int width, height;
};

#ifdef __cplusplus
}  // namespace vk
}  // namespace duo
#endif
#endif
