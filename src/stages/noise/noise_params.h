// Included by C++ and by GLSL.
#ifndef DUO_NOISE_PARAMS_H
#define DUO_NOISE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kNoiseGroup = 64;  // invocations, a block each

struct NoiseBlocksPush {
  Plane left, right;
  int blocks_x, blocks_y;  // of one picture
};

struct NoisePush {
  int share;  // kNoiseShare
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
