// Included by C++ and by GLSL.
#ifndef DUO_BLOCK_MEASURE_PARAMS_H
#define DUO_BLOCK_MEASURE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kMeasureGroup = 64;  // invocations, a block each

struct CountBlocksPush {
  Plane left, right;
  int blocks_x, blocks_y;  // of one picture
};

struct QuantilePush {
  int share;  // one block of so many is at or below a picture's level
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
