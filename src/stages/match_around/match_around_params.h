// Included by C++ and by GLSL.
#ifndef DUO_MATCH_AROUND_PARAMS_H
#define DUO_MATCH_AROUND_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kAroundGroup = 128;     // invocations: blocks of 2x2 pixels, each with so many parts of the candidates
const int kAroundBlocksX = 16;    // most blocks of a workgroup along x
const int kAroundCandidates = 5;  // tried at once: the thesis's finest level has five times as many

struct MatchAroundPush {
  Plane left, right, left_inside, right_inside, coarser, dst;
  int width, height;
  int radius;
  int whole_row;           // 0 or 1: every position of the right row, no coarser level
  int masked;              // 0 or 1: there are inside pictures
  int blocks_x, blocks_y;  // of a workgroup
  int parts;               // blocks_x * blocks_y * parts = kAroundGroup
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
