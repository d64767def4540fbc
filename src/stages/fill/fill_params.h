// Included by C++ and by GLSL.
#ifndef DUO_FILL_PARAMS_H
#define DUO_FILL_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kFillGroup = 128;       // invocations that share a row
const int kFillMaxWidth = 16384;  // px; one bit each in shared memory

struct FillPush {
  Plane d_q4, origin;
  int width;
  int fills;  // 0: only marks what was measured
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
