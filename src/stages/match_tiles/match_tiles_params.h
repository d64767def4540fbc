// Included by C++ and by GLSL.
#ifndef DUO_MATCH_TILES_PARAMS_H
#define DUO_MATCH_TILES_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

// As TileSets: a workgroup of this many invocations has a tile of this size.
const int kTilePixelsX = 48;
const int kTilePixelsY = 16;
const int kTileGroup = 128;

// Of the kernel that prepares one picture's channels, packed into words[y * width + x] of one word (left) or two (right).
struct MatchChannelsPush {
  Plane picture, inside;
  int width, height;
  int clip;
  int right;   // 0 or 1
  int masked;  // 0 or 1: there is an inside picture
};

struct MatchTilesPush {
  Plane sets, left, fine;  // sets: one row a tile
  int width, height;
  int max_disparity;
  int truncation;
  int reach;           // of the windows' shifts along x: 3 or 2
  int all_candidates;  // 0 or 1: there are no sets
};

struct MatchRightPush {
  Plane dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
