// Included by C++ and by GLSL.
#ifndef DUO_PLACE_JOINTS_PARAMS_H
#define DUO_PLACE_JOINTS_PARAMS_H
#include "stages/types/sift_list.h"
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct PlaceJointsPush {
  SiftListShape stored, seen;
  Plane d;
  int width, height;
  int least_blob_pixels, least_votes;
};

const int kPlaceJointsVotes = 256;  // a joint's stored points at most

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
