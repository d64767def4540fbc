// Included by C++ and by GLSL.
#ifndef DUO_BLUR_PARAMS_H
#define DUO_BLUR_PARAMS_H
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
}  // namespace duo
#endif
#endif
