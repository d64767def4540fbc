// Included by C++ and by GLSL.
#ifndef DUO_RECTIFY_PARAMS_H
#define DUO_RECTIFY_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

struct RectifyPush {
  Plane src, corner, fraction, dst, inside;  // src and dst in pixels
  int width, height;
  int marks_inside;  // 0 or 1: there is an inside picture to write
  int columns;       // ResampleMap::Columns
  int src_height;    // of no matter to linear ones
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
