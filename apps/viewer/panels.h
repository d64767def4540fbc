// The five pictures of the window: camera with joints, depth, points, body, hue.
#pragma once

#include <memory>
#include <optional>

#include "duoptic/clicks.h"
#include "duoptic/paint.h"
#include "player.h"
#include "style.h"
#include "texture.h"

namespace duo::app::view {

/// Raw pixels of the camera's picture.
struct ClickAt {
  double x_px = 0, y_px = 0;
};

/// Draws what is shown; gives back where the camera's picture was clicked.
class Panels {
 public:
  Panels(const TrackHeader& header, float scale);

  /// The next draw() shows this.
  Result<void> show(std::shared_ptr<const Shown> shown);
  /// Between two corners of ImGui's current window; a click in raw pixels, when there was one.
  Result<std::optional<ClickAt>> draw(ImVec2 from, ImVec2 to, const Clicks& clicks);
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

  Cell cell(ImVec2 from, ImVec2 to, const char* title, const std::string& note) const;
  Fit picture(const Cell& cell, const Texture& texture);
  std::optional<ClickAt> draw_camera(const Cell& cell, const Clicks& clicks);
  void draw_people(const Fit& fit) const;
  void draw_clicks(const Fit& fit, const Clicks& clicks) const;
  void put_joints(const Cell& cell) const;
  void draw_depth(const Cell& cell);
  void put_depth_legend(const Cell& cell);
  Result<void> draw_cloud_panel(const Cell& cell);
  void turn_cloud(const Cell& cell);
  void draw_region(const Cell& cell);
  void draw_hue_panel(const Cell& cell);

  const TrackHeader header_;
  float scale_;
  std::shared_ptr<const Shown> shown_;
  int shows_ = 0;
  DisparityRange range_;
  Orbit orbit_, drawn_orbit_;
  bool cloud_stale_ = true, pressed_ = false;
  Image<Rgb8> painted_, points_;
  Texture camera_, depth_, region_, hue_, cloud_, turbo_strip_, hue_strip_;
};

}  // namespace duo::app::view
