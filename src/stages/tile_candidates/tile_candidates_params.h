// Included by C++ and by GLSL.
#ifndef DUO_TILE_CANDIDATES_PARAMS_H
#define DUO_TILE_CANDIDATES_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kCandidatesGroup = 128;     // invocations that share a tile
const int kCandidatesMaxWords = 256;  // of 32 bits: disparities below 8192

struct TileCandidatesPush {
  Plane checked, unchecked, sets;  // sets: one row a tile
  int width, height;               // of the coarser level
  int tile_width, tile_height;     // in its pixels
  int max_disparity;
  int grow, margin;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
