// A scene: solids with materials, and lights. Build it, then call ready() once, then trace rays through it.
#pragma once

#include <cstdint>
#include <vector>

#include "sources/synthetic/shapes.h"

namespace duo::synthetic {

/// Linear light or reflectance, red green blue.
struct Color {
  float r = 0, g = 0, b = 0;
};
inline Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Color operator*(Color a, Color b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Color operator*(double s, Color c) {
  const auto f = static_cast<float>(s);
  return {f * c.r, f * c.g, f * c.b};
}
inline Color mixed(Color a, Color b, double t) { return (1 - t) * a + t * b; }
/// From the usual notation 0xRRGGBB (sRGB).
Color srgb(std::uint32_t rrggbb);

enum class Texture : std::uint8_t {
  kPaint,      // plain, barely mottled
  kWallpaper,  // a: ground, b: motif, c: stripes
  kPlanks,     // floor boards along x; a, b: light and dark wood
  kWood,       // furniture, grain along the longest side; a, b likewise
  kRug,        // a: field, b: border, c: motif; fills the top of its box
  kFabric,     // woven, a and b threads, c: pattern
  kKnit,       // a: wool with stripes of b
  kFur,        // a: light, b: dark
  kChecker,    // a, b; `scale_m` is the edge of a square
  kBall,       // eight sectors in a, b, c
  kGlobe,      // a: sea, b: land, c: highlands
  kLeaf,       // a, b: light and dark green, veins
  kSpeckle,    // stoneware: a with grains of b
  kBook,       // a: cover, b: print, c: paper; the spine faces -z
  kPoster,     // a landscape in a, b, c; fills the front (-z) of its box
  kCurtain,    // a with woven ornaments in b
  kSky,        // garden and sky behind the window; a: sky, b: leaves
  // On the resting person:
  kSkin,     // a
  kFace,     // a: skin, b: brows and beard, c: lips; `scale_m` is the strength of the beard, 0 .. 1
  kHair,     // strands in a and b
  kPrint,    // a: shirt, with a badge in b and c on the chest
  kStripes,  // a with stripes of b, every fourth of them c, `scale_m` apart
  kPlaid,    // a crossed by b, with lines of c; `scale_m` is the repeat
  kDenim,    // a with worn threads of b
};

struct Material {
  Texture texture = Texture::kPaint;
  Color a = {}, b = {}, c = {};
  double scale_m = 0.1;
  double gloss = 0;     // strength of the highlight
  double emission = 0;  // light given off, times the texture's colour
};

/// A solid with its place in the world.
struct Shape {
  Solid solid;
  Rigid3 world_from_shape;
  int material = 0;
  bool casts_shadow = true;
};

/// A rectangle centre + u a + v b, |a| <= 1, |b| <= 1, that shines towards its normal; every point of it gives `power`
/// (irradiance at 1 m, straight ahead).
struct Panel {
  Vec3 centre_m, u_m, v_m, normal;
  Color power;
};

/// Light from far away. `spread` is the radius of its disc at distance 1: softness of the shadows.
struct Sun {
  Vec3 towards;  // unit vector to the sun
  double spread = 0;
  Color power;
};

struct Hit {
  int shape = -1;  // -1: nothing
  double t = kNever;
};

class Scene {
 public:
  std::vector<Material> materials;
  std::vector<Shape> shapes;
  std::vector<Panel> panels;
  Sun sun;
  double lift_m = 1e-4;            // shadow rays start so far off a surface, or it would shade itself
  Color ambient_up, ambient_down;  // light from around on surfaces that face up and down

  int add(const Material& material);

  /// Sorts the shapes into a tree of boxes; call it after the last change of shapes.
  void ready();

  /// The first surface along the ray with t > 0.
  Hit trace(const Ray& ray) const;
  /// Where the ray meets one shape alone.
  double trace(const Ray& ray, int shape) const;
  /// Whether anything that casts a shadow lies at 0 < t < 1.
  bool blocked(const Ray& ray) const;

  Vec3 normal(int shape, Vec3 p_in_world) const;

 private:
  struct Bounds {
    Vec3 low{kNever, kNever, kNever}, high{-kNever, -kNever, -kNever};
    void grow(const Bounds& b);
    double area() const;  // half of it
  };
  struct Node {
    Bounds bounds;
    int first = 0, count = 0;  // leaf: count shapes of order_ from first; inner node: count 0, children at first, first + 1
    int axis = 0;
  };
  struct Placed {
    Mat3 shape_from_world;
    Vec3 centre_m;
  };

  void split(int node, const std::vector<Bounds>& bounds);
  template <class Visit>
  void walk(const Ray& ray, const double& t_max, Visit visit) const;
  Ray to_shape(const Ray& ray, int shape) const;

  std::vector<Node> nodes_;
  std::vector<int> order_;
  std::vector<Placed> placed_;
};

}  // namespace duo::synthetic
