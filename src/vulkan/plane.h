// Included by C++ and by GLSL.
#ifndef DUO_VULKAN_PLANE_H
#define DUO_VULKAN_PLANE_H
#ifdef __cplusplus
namespace duo::vk {
#endif

// Where pixel (y, x) lies in its buffer: element offset + y * stride + x. Buffers of at most 128 MiB keep this in 31 bits.
struct Plane {
  int offset;
  int stride;
};

// Workgroup of kernels with one invocation a pixel: 128 invocations is what every Vulkan device must take.
const int kGroupWidth = 16;
const int kGroupHeight = 8;

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
