// Included by C++ and by GLSL.
#ifndef DUO_MATMUL16_PARAMS_H
#define DUO_MATMUL16_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// A workgroup makes so many pixels by so many outputs; its lanes 4 by 4 each.
const int kTilePixels = 32;
const int kTileOutputs = 32;
const int kTilePairs = 16;

struct Matmul16Push {
  Plane x, y;
  int at;                                 // the packed layer's first word
  int inputs, outputs, pixels, pictures;  // pixels of one picture
  int fold, low, high;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
