// Included by C++ and by GLSL: how the kernels of SIFT divide their memory.
#ifndef DUO_SIFT_PARAMS_H
#define DUO_SIFT_PARAMS_H
#include "stages/types/sift_list.h"
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#define DUO_INLINE inline
#else
#define DUO_INLINE
#endif

const int kSiftLevels = 3;  // an octave
const int kSiftBlurred = kSiftLevels + 3;
const int kSiftPlanes = 2 * kSiftBlurred - 1;  // an octave: blurred ones, then their differences
const int kSiftBorder = 5;                     // px of an octave without extrema
const int kSiftSmallest = 12;                  // px of an octave
const int kSiftMostAngles = 4;                 // a place
const int kSiftMostBlur = 12;                  // px, radius
const int kSiftLanes = 128;                    // invocations of most workgroups
const int kSiftMostCandidates = 1 << 15;
const int kSiftFixed = 4096;  // histogram units a gray level

// What all kernels know.
struct SiftShape {
  int width, height;            // of the picture
  int room_width, room_height;  // of the largest window with its margins
  int octaves, margin_px;
  int windows;     // as many lists of points
  int capacity;    // points of a list
  int candidates;  // extrema of a window, before refinement
};

// Planes of octave k have the room's size divided by 2^k, rounded up; how many pixels one plane of each earlier octave has.
DUO_INLINE int sift_pixels_before(SiftShape shape, int octave) {
  int pixels = 0;
  for (int k = 0; k < octave; ++k)
    pixels += ((shape.room_width + (1 << k) - 1) >> k) * ((shape.room_height + (1 << k) - 1) >> k);
  return pixels;
}

// Tiles of the blur, px.
const int kSiftTileWidth = 32, kSiftTileHeight = 16;

struct SiftBlurPush {
  SiftShape shape;
  Plane src;
  int octave, level;  // of the result; level 0, of octave 0 only, comes from the picture
  int radius;
  float weight[kSiftMostBlur + 1];
};

struct SiftPointPush {
  SiftShape shape;
  float least_difference;  // of an extremum, gray levels
  float contrast, edge;    // SiftParams
  int step;                // of the kernel that makes lists
};

// One after the other.
const int kSiftCandidates = 0, kSiftPlaces = 1, kSiftPoints = 2;
// Offsets of the three sizes of indirect dispatches, in words.
const int kSiftRefineGroups = 0, kSiftOrientGroups = 3, kSiftDescribeGroups = 6, kSiftGroupWords = 9;
const int kSiftRefineLanes = 64;

// Lists of a window, in words: counts; a bit for each position that is an extremum; positions of candidates; their places;
// those that are kept; of each point its place and angle.
const int kSiftPlaceWords = 13;
const int kSiftCounts = 3;  // candidates, overflow, kept places
// Place: x, y, scale, response; octave, level; what became of it; position; how many angles, and these, in turns.
const int kSiftNoPlace = 0, kSiftStays = 1, kSiftMoved = 2;

struct SiftWork {
  int bits, candidates, places, kept, points, words;
};
DUO_INLINE SiftWork sift_work(SiftShape shape) {
  SiftWork work;
  work.bits = kSiftCounts;
  work.candidates =
      work.bits + (kSiftLevels * sift_pixels_before(shape, shape.octaves) + kSiftLanes - 1) / kSiftLanes * (kSiftLanes / 32);
  work.places = work.candidates + shape.candidates;
  work.kept = work.places + kSiftPlaceWords * shape.candidates;
  work.points = work.kept + shape.candidates;
  work.words = work.points + shape.capacity;
  return work;
}

#undef DUO_INLINE
#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
