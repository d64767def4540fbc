// Drawing: what was found as pictures, and as shapes over a picture.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "duoptic/detector.h"
#include "duoptic/frame.h"
#include "duoptic/person.h"
#include "duoptic/rig.h"
#include "duoptic/sink.h"

namespace [[gnu::visibility("default")]] duo {

/// The disparities that get the first and the last colour.
struct DisparityRange {
  double far_px = 0, near_px = 0;
  bool empty() const { return near_px <= far_px; }
};
/// From the 1st to the 99th percentile of the valid pixels, at least 1 px wide; empty without any.
DisparityRange disparity_range(View<const std::uint16_t> d_q4);

/// The same with room for an arm that is stretched out to the cameras, `nearer` times as near, and without the few far points
/// that noise makes before a bare wall: no farther than thrice what is near.
DisparityRange roomy_range(View<const std::uint16_t> d_q4, double nearer);

/// Disparity as colours: the Turbo map (Mikhailov 2019), near is red, none is black, with a legend; the legend is in
/// metres when `rectified` is given, else in px. The range of the colours is disparity_range().
Image<Rgb8> draw_disparity(View<const std::uint16_t> d_q4, const Rectified* rectified);

/// Colour maps from far to near. Cividis (Nunez, Anderton, Renslow, 2018) reads alike with any colour vision.
enum class DepthColors : std::uint8_t { kTurbo, kCividis, kGray };

/// Disparity in the colours of draw_disparity(), or others, over a given range; black where there is none.
///
/// Shape  both H x W
void color_disparity(View<const std::uint16_t> d_q4, const DisparityRange& range, View<Rgb8> dst,
                     DepthColors colors = DepthColors::kTurbo);

/// The colours of color_disparity() from far to near, 256 px, one high.
Image<Rgb8> depth_strip(DepthColors colors);

/// What of a drawn depth map was not matched (Frame::matched): the rectified picture, dark and gray, with a line around the
/// part that was matched.
///
/// Shape  dst like the frame's maps
void draw_unmatched(const Frame& frame, View<Rgb8> dst);

/// The colour of a joint in draw_regions().
Rgb8 shade_of(JointId joint);

/// The rectified picture, dark and gray, with the persons' pixels in the shade of the joint they are nearest to. A person is
/// what lies within the joints' radius of the bones between joints that are not lost; of trunk, neck and head within
/// 1.4 times as much.
///
/// Shape  dst like the frame's maps; of these it needs disparity and colour
void draw_regions(const Frame& frame, const Rectified& rectified, std::span<const Person> people, View<Rgb8> dst);

/// Hue as colour, saturation as brightness.
///
/// Shape  src and dst H x W
void draw_hue(View<const Rgb8> src, View<Rgb8> dst);

/// The hues of draw_hue() from 0 to 360 degrees, 256 px, one high.
Image<Rgb8> hue_strip();

/// Pictures side by side, top-aligned on black.
Image<Rgb8> side_by_side(std::span<const View<const Rgb8>> pictures);
/// Both rectified pictures of a frame that has them, gray.
Image<Rgb8> draw_rectified(const Frame& frame);

/// The cloud drawn from a camera moved sideways and up, so that a person sees its shape without a 3D program.
Image<Rgb8> draw_cloud(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified, Size size);

/// A camera on a sphere around a point that it looks at.
///
/// Units  rig frame; yaw to the right, pitch up; zoom 1: as large as the rig's own camera sees it
struct Orbit {
  double yaw_rad = -0.3, pitch_rad = 0.2, zoom = 1;
  double middle_m = 2;  // of what is looked at, straight ahead of the rig
  friend bool operator==(const Orbit&, const Orbit&) = default;
};

/// The orbit's camera for a picture of some size.
class OrbitCamera {
 public:
  OrbitCamera(const Orbit& orbit, const Rectified& rectified, Size size);
  /// x and y in its picture, px, and z in front of it, m; none behind the camera.
  std::optional<Vec3> place(Vec3 p_in_rig_m) const;
  double focal_px() const { return focal_px_; }
  double middle_m() const { return middle_in_rig_m_.z; }

 private:
  Mat3 turn_;
  Vec3 middle_in_rig_m_;
  double distance_m_, focal_px_, cx_px_, cy_px_;
};

/// The depth that a quarter of the points is nearer than, metres; 0 without any.
double foreground_m(View<const std::uint16_t> d_q4, const Rectified& rectified);

/// Each point as a square as large as its pixel, what is nearest in front.
///
/// Shape  d_q4 and color H x W of the frame, dst of any size
void draw_points(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified, const OrbitCamera& camera,
                 View<Rgb8> dst);

/// What a detector saw, over its picture: bones, points and boxes; the left side warm, the right one cold, pale what is
/// probably hidden, hands with a colour a finger.
void draw_people(std::span<const SeenPerson> people, View<Rgb8> picture);

/// Persons as shapes over the raw left picture, in its pixels; broken where a joint is inferred, left out where it is lost.
/// Fingers have bones alone, and take the place of the box around their palm.
struct Shapes {
  struct Line {
    double x0_px = 0, y0_px = 0, x1_px = 0, y1_px = 0;
    bool broken = false;
    bool thin = false;  // a finger's
  };
  struct Mark {
    double x_px = 0, y_px = 0, half_px = 0, sigma_px = 0;  // a box around a joint, as wide as a hand, and a ring of one sigma
    bool broken = false;
  };
  std::vector<Line> bones;
  std::vector<Mark> joints;
};
Shapes shapes_of(std::span<const Person> people, const TrackHeader& header);

/// What a caption says of one joint, or of a person with more joints than a caption has room for.
struct Label {
  std::string text;   // "hand 1.32 m"
  std::string sigma;  // "2 cm"; empty when lost
  JointState state = JointState::kLost;
};
/// The ends of limbs come first; of a person with fingers the pinches that are known come last.
std::vector<Label> labels_of(const Person& person, bool metric = true);

/// The joints that captions explain the shades of: each part of the body once, of whichever side.
std::vector<JointId> shaded_joints(const TrackHeader& header);

/// One entry of a caption's key to the shades.
struct ShadeKey {
  std::string name;             // of a joint, or of a limb where a caption has no room for all joints: trunk, arm, leg
  std::vector<JointId> joints;  // whose shades it explains
};
std::vector<ShadeKey> shade_keys(const TrackHeader& header);

/// The thesis's four panels: the raw left picture with joints as green boxes and bones as red lines, both broken where a joint
/// is inferred; depth in colours over `range`, with a legend in metres; the persons' pixels in a shade per joint; hue as
/// colour with saturation as brightness. The same size for every frame of a recording, even in both directions.
Image<Rgb8> draw_panels(const TrackedFrame& frame, const TrackHeader& header, const DisparityRange& range);

/// Of draw_panels(), whatever the frame.
Size panels_size(const TrackHeader& header);

}  // namespace duo
