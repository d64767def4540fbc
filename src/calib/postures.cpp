#include "calib/postures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace duo {
namespace {

/// How one camera may be held or set up that the other is not.
struct Posture {
  const char* what;
  Image<Rgb8> (*undone)(const Image<Rgb8>& picture);
};

template <class Place>
Image<Rgb8> moved_pixels(const Image<Rgb8>& picture, const Place& place) {
  const auto [w, h] = picture.size();
  Image<Rgb8> out(picture.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto [from_x, from_y] = place(x, y);
      out.at(y, x) = from_x < 0 || from_y < 0 || from_x >= w || from_y >= h ? Rgb8{} : picture.at(from_y, from_x);
    }
  return out;
}

Image<Rgb8> half_turn(const Image<Rgb8>& picture) {
  const auto [w, h] = picture.size();
  return moved_pixels(picture, [w = w, h = h](int x, int y) { return std::pair(w - 1 - x, h - 1 - y); });
}
Image<Rgb8> mirror(const Image<Rgb8>& picture) {
  return moved_pixels(picture, [w = picture.width()](int x, int y) { return std::pair(w - 1 - x, y); });
}
Image<Rgb8> rows_in_reverse(const Image<Rgb8>& picture) {
  return moved_pixels(picture, [h = picture.height()](int x, int y) { return std::pair(x, h - 1 - y); });
}
Image<Rgb8> negative(const Image<Rgb8>& picture) {
  Image<Rgb8> out(picture.size());
  for (int y = 0; y < out.height(); ++y)
    std::transform(picture.row(y), picture.row(y) + out.width(), out.row(y), [](Rgb8 p) {
      const auto other = [](std::uint8_t value) { return static_cast<std::uint8_t>(255 - value); };
      return Rgb8{other(p.r), other(p.g), other(p.b)};
    });
  return out;
}
/// Of the square in the middle; black beside it.
Image<Rgb8> quarter_turn(const Image<Rgb8>& picture) {
  const auto [w, h] = picture.size();
  const int side = std::min(w, h), x0 = (w - side) / 2, y0 = (h - side) / 2;
  return moved_pixels(picture, [=](int x, int y) {
    const int i = x - x0, j = y - y0;
    return i < 0 || j < 0 || i >= side || j >= side ? std::pair(-1, -1) : std::pair(x0 + j, y0 + side - 1 - i);
  });
}
Image<Rgb8> three_quarter_turn(const Image<Rgb8>& picture) { return half_turn(quarter_turn(picture)); }

constexpr char kOnSide[] = "one picture lies on its side: turn that camera by 90 degrees, or its picture";
constexpr Posture kPostures[] = {
    {"one picture stands on its head: turn that camera by 180 degrees, or its picture", half_turn},
    {"one picture is mirrored and the other is not: switch the mirroring of that camera off", mirror},
    {"one picture has its rows from bottom to top: switch that camera's flip off, or turn its picture over", rows_in_reverse},
    {"one picture is a negative of the other: switch the inverting of that camera off, or invert its picture", negative},
    {kOnSide, quarter_turn},
    {kOnSide, three_quarter_turn}};

constexpr double kByChance = 0.025,  // share of points that match in pictures of two places: up to 0.014
    kOfOneScene = 0.06;              // and of one: from 0.09 on, in a bare hall

}  // namespace

std::size_t alike_in(const SceneMatches& scene) { return scene.matches.size() / static_cast<std::size_t>(scene.pairs); }
bool are_of_one_scene(const SceneMatches& scene) {
  return static_cast<double>(alike_in(scene)) > kOfOneScene * scene.fewest_points;
}

std::string why_held_otherwise(const SceneMatches& scene, const Pair& pair, int threads) {
  constexpr std::size_t kFewest = 8, kTimes = 4;  // matches of a picture whose posture is undone, and how many more than before
  const std::size_t alike = alike_in(scene);
  const double points = scene.fewest_points;
  if (points < kFewest || are_of_one_scene(scene)) return {};
  Pair other{{pair.left.pixels.clone()}, {}};
  for (const Posture& posture : kPostures) {
    other.right.pixels = posture.undone(pair.right.pixels);
    const std::size_t undone = match_pair(other, threads).matches.size();
    if (undone >= kFewest && undone > kTimes * alike && static_cast<double>(undone) > kOfOneScene * points) return posture.what;
  }
  return {};
}

std::string why_apart(const SceneMatches& scene, const Pair& pair, int threads) {
  if (std::string why = why_held_otherwise(scene, pair, threads); !why.empty() || are_of_one_scene(scene)) return why;
  const std::size_t alike = alike_in(scene);
  const double points = scene.fewest_points;
  if (points < kManyPoints || static_cast<double>(alike) > kByChance * points) return {};
  return fmt::format(
      "left and right have nothing in common: of {} points in a picture {} look alike; give pictures of one scene at one "
      "moment, of cameras that look the same way",
      scene.fewest_points, alike);
}

}  // namespace duo
