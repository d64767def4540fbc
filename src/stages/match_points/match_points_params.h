// Included by C++ and by GLSL.
#ifndef DUO_MATCH_POINTS_PARAMS_H
#define DUO_MATCH_POINTS_PARAMS_H
#include "stages/types/sift_list.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct MatchPointsPush {
  SiftListShape stored, seen;
  int ratio_percent;
  int gated;  // 0 or 1: there are predicted places
  float square_reach_px;
  int mutual;  // 0: nearest and ratio; 1: takes away matches that are not mutual
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
