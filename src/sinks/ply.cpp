#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>

#include "core/check.h"
#include "core/file.h"
#include "core/point.h"
#include "duoptic/sink.h"

namespace duo {

static_assert(std::endian::native == std::endian::little, "PLY files are written as the machine holds its floats");

Result<void> write_ply(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified,
                       const std::filesystem::path& path, const CloudOptions& options) {
  constexpr std::array<const char*, kAxesNames.size()> kDirections = {"x right, y down, z forward", "x forward, y left, z up",
                                                                      "x right, y up, z backward", "x right, y up, z forward",
                                                                      "x right, y forward, z up"};
  const Mat3& turn = axes_from_rig(options.axes);
  DUO_CHECK(d_q4.size() == color.size());
  std::string vertices;
  std::size_t count = 0;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      if (const auto p_in_rig_m = point_at(d_q4, rectified, y, x); p_in_rig_m && p_in_rig_m->z <= options.far_m) {
        const Vec3 p_m = turn * *p_in_rig_m;
        const std::array<float, 3> xyz = {static_cast<float>(p_m.x), static_cast<float>(p_m.y), static_cast<float>(p_m.z)};
        const Rgb8 c = color.at(y, x);
        std::array<char, 15> vertex;
        std::memcpy(vertex.data(), xyz.data(), 12);
        std::memcpy(vertex.data() + 12, &c, 3);
        vertices.append(vertex.data(), vertex.size());
        ++count;
      }
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}; {}\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n",
      options.metric ? "metres" : "not metric: units of a guessed baseline",
      kDirections[static_cast<std::size_t>(options.axes)], count);
  return write_file(path, header + vertices);
}

}  // namespace duo
