// Included by C++ and by GLSL.
#ifndef DUO_BLUR_PARAMS_H
#define DUO_BLUR_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo {
#endif

const int kBlurBlock = 8;     // px, both ways
const int kBlurRowStep = 16;  // px from one row of blocks to the next
const int kBlurFar = 3;       // px, the larger of both distances
const int kBlurBins = 512;    // of sums over a block, the last one for all above
const int kBlurBinStep = 4;
const int kBlurShare = 20;     // one block of so many is at or below a picture's level
const int kBlurUnknown = 255;  // and the most there is

#ifdef __cplusplus
namespace vk {
#endif

const int kBlurGroup = 64;  // invocations, a block each

struct BlurBlocksPush {
  Plane left, right;
  int blocks_x, blocks_y;  // of one picture
};

struct BlurPush {
  int share;  // kBlurShare
};

#ifdef __cplusplus
}  // namespace vk
}  // namespace duo
#endif
#endif
