// The five pictures of the window: camera with joints, depth, points, body, hue or the rectified pair.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "duoptic/clicks.h"
#include "duoptic/depth_quality.h"
#include "duoptic/paint.h"
#include "duoptic/player.h"
#include "style.h"
#include "texture.h"

namespace duo::app::view {

/// Raw pixels of the camera's picture.
struct ClickAt {
  double x_px = 0, y_px = 0;
};

/// What its user chooses of how pictures are drawn.
struct ViewChoices {
  DepthColors colors = DepthColors::kTurbo;
  bool own_range = false;  // near_m .. far_m; else the range follows the scene
  float near_m = 0.5f, far_m = 4;
  bool rectified_pair = false;  // in place of hue
  float wall_m = 0;             // true distance of the wall that is measured; 0: not known
};

/// Draws what is shown; gives back where the camera's picture was clicked.
class Panels {
 public:
  Panels(const TrackHeader& header, float scale);

  /// The next draw() shows this.
  Result<void> show(std::shared_ptr<const Shown> shown);
  /// Between two corners of ImGui's current window; a click in raw pixels, when there was one.
  Result<std::optional<ClickAt>> draw(ImVec2 from, ImVec2 to, const Clicks& clicks);
  ViewChoices& choices() { return choices_; }
  /// One panel alone, or all of them again.
  void enlarge(std::optional<int> panel) { enlarged_ = panel; }
  /// A click has begun: it is where the button is let go.
  bool pressed() const { return pressed_; }

 private:
  /// A panel: its title above, its picture, its caption below.
  struct Cell {
    ImVec2 from, to, caption;  // caption: where its text begins
    float caption_width;
  };
  /// Where a picture lies in the window, whole and in its own shape.
  struct Fit {
    ImVec2 from, to;
    float scale;  // window pixels for each of the picture's
    ImVec2 place(double u_px, double v_px) const {
      return {from.x + (static_cast<float>(u_px) + 0.5f) * scale, from.y + (static_cast<float>(v_px) + 0.5f) * scale};
    }
  };

  enum Panel : int { kCamera, kDepth, kPoints, kBody, kLast, kPanels };
  struct Box {
    ImVec2 from, to;
  };
  std::array<Box, kPanels> boxes(ImVec2 from, ImVec2 to) const;
  void take_double_click(const std::array<Box, kPanels>& boxes, const Clicks& clicks);
  Result<void> paint_depth();
  Cell cell(const Box& box, const char* title, const std::string& note) const;
  Fit picture(const Cell& cell, const Texture& texture);
  std::optional<ClickAt> draw_camera(const Cell& cell, const Clicks& clicks);
  void draw_people(const Fit& fit) const;
  void draw_clicks(const Fit& fit, const Clicks& clicks) const;
  void put_joints(const Cell& cell) const;
  void draw_depth(const Cell& cell);
  void put_depth_at_pointer(const Fit& fit) const;
  void put_depth_legend(const Cell& cell);
  void drag_region(const Fit& fit);
  Result<void> draw_rectified_pair(const Cell& cell);
  Result<void> draw_cloud_panel(const Cell& cell);
  void turn_cloud(const Cell& cell);
  void draw_region(const Cell& cell);
  void draw_hue_panel(const Cell& cell);

  const TrackHeader header_;
  float scale_;
  std::shared_ptr<const Shown> shown_;
  int shows_ = 0;
  ViewChoices choices_, painted_choices_;
  std::optional<int> enlarged_;
  RegionQuality quality_;
  std::optional<ImVec2> drag_from_;     // in the depth picture, px
  DisparityRange range_, shown_range_;  // that follows the scene; that is drawn
  Orbit orbit_, drawn_orbit_;
  bool cloud_stale_ = true, depth_stale_ = true, pair_stale_ = true, pressed_ = false;
  Image<Rgb8> painted_, points_;
  Texture camera_, depth_, region_, hue_, pair_, cloud_, depth_strip_, hue_strip_;
};

}  // namespace duo::app::view
