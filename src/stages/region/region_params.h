// Included by C++ and by GLSL.
#ifndef DUO_REGION_PARAMS_H
#define DUO_REGION_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// duo::Region in whole words; all zero = an empty window.
struct RegionTask {
  int bit;
  int x, y, x_end, y_end;
  int seed_y, seed_x;
};

const int kRegionLanes = 128;  // invocations of a workgroup
const int kRegionGroups = 32;  // workgroups a task that choose
const int kMostRegions = 8;    // one a bit

// One after the other.
const int kRegionRuns = 0, kRegionJoin = 1, kRegionCount = 2, kRegionChoose = 3, kRegionClear = 4;

struct RegionPush {
  Plane marks;
  int width, height;
  int tasks;
  int room;  // pixels of the largest window
  int step;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
