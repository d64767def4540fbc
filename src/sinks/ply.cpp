#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>

#include "core/check.h"
#include "core/file.h"
#include "duoptic/sink.h"
#include "core/point.h"

namespace duo {

static_assert(std::endian::native == std::endian::little, "PLY files are written as the machine holds its floats");

Result<void> write_ply(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified,
                       const std::filesystem::path& path) {
  DUO_CHECK(d_q4.size() == color.size());
  std::string vertices;
  std::size_t count = 0;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      if (const auto p_in_rig_m = point_at(d_q4, rectified, y, x)) {
        const std::array<float, 3> xyz = {static_cast<float>(p_in_rig_m->x), static_cast<float>(p_in_rig_m->y),
                                          static_cast<float>(p_in_rig_m->z)};
        const Rgb8 c = color.at(y, x);
        std::array<char, 15> vertex;
        std::memcpy(vertex.data(), xyz.data(), 12);
        std::memcpy(vertex.data() + 12, &c, 3);
        vertices.append(vertex.data(), vertex.size());
        ++count;
      }
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment metres; x right, y down, z forward\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n",
      count);
  return write_file(path, header + vertices);
}

}  // namespace duo
