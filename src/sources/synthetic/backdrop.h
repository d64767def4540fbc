// A still room in one camera, rendered once; a person is drawn into it picture by picture.
#pragma once

#include <array>

#include "sources/synthetic/render.h"

namespace duo::synthetic {

/// The lights of a room in three groups that add up: what comes through the window, the ceiling lamp, and all else.
struct Lamps {
  double ceiling = 1;
  /// Half of the ambient light is the lamp's, sent back by the walls.
  double ambient() const { return 0.5 + 0.5 * ceiling; }
};

/// The room's lights with the lamp at a power, for a scene of its own: no sun, which reaches the floor only.
void light_like(const Scene& room, const Lamps& lamps, Scene& into);

class Backdrop {
 public:
  Backdrop(Pool& pool, const Scene& room, const Camera& camera, const Rigid3& world_from_camera);

  struct Drawn {
    Image<Color> colors;
    Image<float> z_m;               // of what each pixel's centre shows
    Image<std::uint8_t> is_figure;  // 255 where that is the figure
  };
  /// The figure in the room, shaded by itself and casting soft shadows; nearer furniture hides it.
  ///
  /// Exact  depth as render() would give it for room and figure together; the same bits with any number of threads
  Drawn draw(Pool& pool, const Scene& figure, const Lamps& lamps) const;

  const Camera& camera() const { return camera_; }

 private:
  static constexpr int kGroups = 3;
  struct Box2 {
    int left = 0, top = 0, right = 0, bottom = 0;  // right and bottom lie outside
  };
  Box2 outline(const Scene& figure) const;
  void draw_room(Pool& pool, const Scene& figure, const Lamps& lamps, Drawn& out) const;
  void draw_figure(Pool& pool, const Scene& figure, const Box2& box, Drawn& out) const;

  Camera camera_;
  Rigid3 world_from_camera_;
  Image<Point2> rays_;  // on the plane z = 1
  Image<Surface> surfaces_;
  std::array<Image<Color>, kGroups> groups_;
  std::array<Panel, 2> panels_;  // window and ceiling
};

}  // namespace duo::synthetic
