// The parts that draw_panels() puts together.
#pragma once

#include <array>

#include "duoptic/sink.h"

namespace duo {

/// Of draw_panels(): whatever the frame.
Size panels_size(const Recording& recording);

/// The shades of hand, elbow and shoulder.
inline constexpr std::array<Rgb8, kArmJoints> kShades = {Rgb8{190, 255, 170}, Rgb8{70, 190, 90}, Rgb8{24, 112, 62}};

/// The rectified picture, dark and gray, with the arm's pixels in the shade of the joint they are nearest to. The arm is what
/// lies within a hand's, forearm's or upper arm's radius of the bones between joints that are not lost.
///
/// Shape  dst like the frame's maps
void draw_arm_region(const Frame& frame, const Rectified& rectified, const std::vector<ArmPose>& arms, View<Rgb8> dst);

/// Hue as colour, saturation as brightness.
///
/// Shape  src and dst H x W
void draw_hue(View<const Rgb8> src, View<Rgb8> dst);

/// The colour of a hue at full saturation.
///
/// Units  256 = full circle
Rgb8 color_of_hue(int hue);

}  // namespace duo
