// Included by C++ and by GLSL: lists of SIFT points as kernels keep them, several lists of one capacity in one buffer.
#ifndef DUO_STAGES_SIFT_LIST_H
#define DUO_STAGES_SIFT_LIST_H
#ifdef __cplusplus
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

#include "core/check.h"
#include "stages/types/sift_points.h"
namespace duo {
#endif

// In words, one kind of all lists after the other, so that counts and points can be read back without descriptors: of each list
// count and overflow; of each place in a list a SiftPoint; of each its descriptor.
struct SiftListShape {
  int lists, capacity;
};
const int kSiftHeadWords = 2, kSiftPointWords = 6, kSiftDescriptorWords = 32;

#ifdef __cplusplus

/// Bytes of the counts and points of all lists, without or with their descriptors.
inline std::size_t sift_point_bytes(const SiftListShape& shape) {
  const auto lists = static_cast<std::size_t>(shape.lists), capacity = static_cast<std::size_t>(shape.capacity);
  return 4 * lists * (kSiftHeadWords + kSiftPointWords * capacity);
}
inline std::size_t sift_list_bytes(const SiftListShape& shape) {
  const auto places = static_cast<std::size_t>(shape.lists) * static_cast<std::size_t>(shape.capacity);
  return sift_point_bytes(shape) + 4 * kSiftDescriptorWords * places;
}

static_assert(sizeof(SiftPoint) == 4 * kSiftPointWords && offsetof(SiftPoint, octave) == 20 &&
              offsetof(SiftPoint, level) == 21);
static_assert(SiftPoints::kDescriptor == 4 * kSiftDescriptorWords);

/// Puts points into one of the lists of a buffer, which has room for them.
inline void write_sift_list(const SiftPoints& points, const SiftListShape& shape, int list, std::span<std::byte> buffer) {
  DUO_CHECK(points.count <= shape.capacity && list < shape.lists && buffer.size() >= sift_list_bytes(shape));
  const auto first = static_cast<std::size_t>(list) * static_cast<std::size_t>(shape.capacity);
  const std::int32_t head[kSiftHeadWords] = {points.count, points.overflow};
  std::memcpy(buffer.data() + static_cast<std::size_t>(list) * sizeof head, head, sizeof head);
  std::byte* const to = buffer.data() + 4 * kSiftHeadWords * static_cast<std::size_t>(shape.lists);
  std::copy_n(reinterpret_cast<const std::byte*>(points.points.data()),
              static_cast<std::size_t>(points.count) * sizeof(SiftPoint), to + first * sizeof(SiftPoint));
  std::byte* descriptor = buffer.data() + sift_point_bytes(shape) + first * SiftPoints::kDescriptor;
  for (int i = 0; i < points.count; ++i, descriptor += SiftPoints::kDescriptor)
    std::memcpy(descriptor, points.descriptors.row(i), SiftPoints::kDescriptor);
}

/// Takes one of the lists out of a buffer, into points with room for it; without descriptors where the buffer ends before them.
inline void read_sift_list(std::span<const std::byte> buffer, const SiftListShape& shape, int list, SiftPoints& points) {
  DUO_CHECK(list < shape.lists && buffer.size() >= sift_point_bytes(shape));
  const auto first = static_cast<std::size_t>(list) * static_cast<std::size_t>(shape.capacity);
  std::int32_t head[kSiftHeadWords];
  std::memcpy(head, buffer.data() + static_cast<std::size_t>(list) * sizeof head, sizeof head);
  points.count = head[0];
  points.overflow = head[1];
  DUO_CHECK(points.count >= 0 && points.count <= shape.capacity && points.count <= points.capacity());
  const std::byte* const from = buffer.data() + 4 * kSiftHeadWords * static_cast<std::size_t>(shape.lists);
  std::copy_n(from + first * sizeof(SiftPoint), static_cast<std::size_t>(points.count) * sizeof(SiftPoint),
              reinterpret_cast<std::byte*>(points.points.data()));
  if (buffer.size() < sift_list_bytes(shape)) return;
  const std::byte* descriptor = buffer.data() + sift_point_bytes(shape) + first * SiftPoints::kDescriptor;
  for (int i = 0; i < points.count; ++i, descriptor += SiftPoints::kDescriptor)
    std::memcpy(points.descriptors.row(i), descriptor, SiftPoints::kDescriptor);
}

}  // namespace duo
#else

int sift_head(int list) { return kSiftHeadWords * list; }
int sift_point(SiftListShape shape, int list, int i) {
  return kSiftHeadWords * shape.lists + kSiftPointWords * (list * shape.capacity + i);
}
int sift_descriptor(SiftListShape shape, int list, int i) {
  return (kSiftHeadWords + kSiftPointWords * shape.capacity) * shape.lists + kSiftDescriptorWords * (list * shape.capacity + i);
}

#endif
#endif
