// A frame as it is for somebody whom others stand before: what they cover is taken out.
#pragma once

#include "trackers/body/frame_view.h"

namespace duo::body {

/// Takes other people out of a frame, so that the networks and the depth show one person alone.
///
/// Allocates at the first frame of a size.
class Uncover {
 public:
  /// Starts from the whole frame. `trunk_z_m`: depth of the person's own trunk.
  void begin(const FrameView& frame, double trunk_z_m);
  /// Somebody nearer: what lies before `z_m` in a box, and what is so close to it that its edge may reach there. Its depth is
  /// taken out as well.
  void take_out_before(const Window& box_px, double z_m);
  /// Somebody farther away: what lies behind `z_m` in a box.
  void take_out_behind(const Window& box_px, double z_m);
  /// Fills the picture from both sides of what was taken out, so that no outline stays; from one side alone where the person
  /// itself is on the other, so that the person's own outline does.
  void finish();
  const FrameView& view() const { return frame_; }

 private:
  FrameView frame_;
  double trunk_z_m_ = 0;
  Image<Rgb8> picture_;
  Image<std::uint16_t> d_q4_;
  Image<std::uint8_t> covered_, taken_, nearer_;
};

}  // namespace duo::body
