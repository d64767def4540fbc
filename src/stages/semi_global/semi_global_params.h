// Included by C++ and by GLSL.
#ifndef DUO_SEMI_GLOBAL_PARAMS_H
#define DUO_SEMI_GLOBAL_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kPathGroup = 128;   // invocations: as many lines as there are subgroups in it
const int kCostGroup = 128;   // invocations of the pixel costs
const int kCostRun = 16;      // columns that each of them walks
const int kMostVolumes = 4;   // of summed paths that the winners read
const int kPackedPlanes = 3;  // words of a pixel, as stages/match_planes packs them

struct SemiGlobalCostsPush {
  Plane left, right;  // packed planes
  int width, height;
  int max_disparity, words;  // of a pixel in a volume: four disparities each
  int census_most, most;
  int p2_least, p2_least_unclear;
};

struct SemiGlobalPathPush {
  Plane left;
  int width, height;
  int words;
  int p1, p2, p2_gradient;
  int dx, dy;  // one step along the path
  int adds;    // 0 or 1: to what the volume holds
};

struct SemiGlobalPush {
  Plane left, right_winner;
  int width, height;
  int words;
  int p1, p2, p2_gradient;
  int wants_margin;  // 0 or 1
};

struct SemiGlobalFinePush {
  Plane left_winner, fine, margin;
  int width, height;
  int max_disparity;
  int wants_margin;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
