// Included by C++ and by GLSL.
#ifndef DUO_SAMPLE_DEPTH_PARAMS_H
#define DUO_SAMPLE_DEPTH_PARAMS_H
#include "vulkan/area.h"
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// Counts of an area: its pixels by the high byte of their disparity; for each rank, those with its high byte by the low one;
// all.
const int kDepthRanks = 3;
const int kDepthBins = 256;
const int kDepthLow = kDepthBins;  // first of kDepthRanks times kDepthBins
const int kDepthAll = kDepthLow + kDepthRanks * kDepthBins;
const int kDepthCounts = kDepthAll + 1;

const int kCountHigh = 0, kCountLow = 1, kSelect = 2;

struct SampleDepthPush {
  Plane d, marks;
  int width, height;
  int with_marks;  // 0 or 1
  int step;        // kCountHigh, kCountLow, kSelect: one after the other
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
