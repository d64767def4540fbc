// A synthetic rig in a synthetic room: pictures with exact depth, made by our own renderer.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/rig.h"
#include "duoptic/skeleton.h"

namespace [[gnu::visibility("default")]] duo {

struct SyntheticSetup {
  Size size = {640, 480};
  std::uint32_t seed = 1;  // layout, textures, mounting errors and noise
  double t_s = 0;          // moment of the scene: a ball swings, a globe turns
  bool ideal = false;      // true: rectified pinhole cameras without noise or distortion
};

/// One moment of the scene seen by both cameras, with its truth.
///
/// Shape   all H x W of setup.size
/// Units   depth_left_m: z of the first surface in the raw left camera, metres, at each raw left pixel (through its
///         distortion); disparity_px: exact x_left - x_right of the ideal pair, only when `ideal`
struct SyntheticPair {
  Pair pair;
  Rig rig;
  Image<float> depth_left_m;
  Image<float> disparity_px;
  Image<std::uint8_t> seen_by_both;  // 255 where the right camera sees the same surface point, only when `ideal`
};

/// Renders one moment. The same setup gives the same bits on every machine and with any number of threads.
SyntheticPair render_synthetic(const SyntheticSetup& setup, int threads);

/// The rig of a setup without rendering: two webcams mounted by hand, or the perfect pair when `ideal`.
Rig synthetic_rig(const SyntheticSetup& setup);

/// The rectified geometry of the ideal pair.
Rectified synthetic_rectified(const SyntheticSetup& setup);

// --- A person in the room -----------------------------------------------------------------------------------------------

enum class SyntheticArm : std::uint8_t { kBySeed, kRight, kLeft };  // the person's own right or left

struct SyntheticClipSetup {
  Size size = {640, 480};
  std::uint32_t seed = 1;       // room, rig and noise as in SyntheticSetup; the person's looks, place and sway
  std::string script = "tour";  // see synthetic_scripts()
  int frames = 0;               // 30 a second; 0: the script once; more than it has: it starts again
  SyntheticArm arm = SyntheticArm::kBySeed;
  double skew_s = 0;  // the right camera's shutter opens that much later than the left one's, as free-running webcams' do
};

/// Where a joint is. It lies inside the body: what a camera sees of it is nearer.
struct SyntheticJoint {
  JointId id = JointId::kPelvis;
  Vec3 p_in_left_m;                                              // in the raw left camera
  std::optional<std::array<double, 2>> uv_left_px, uv_right_px;  // in the raw pictures; none far outside of them
  bool in_left = false, in_right = false;                        // inside the picture
  bool visible_left = false, visible_right = false;              // and nothing farther in front than flesh and cloth are thick
  std::optional<double>
      surface_z_left_m;  // of the person's first surface on the way to the joint; none where the room hides it
};

/// One moment of a clip, with its truth: all of the left picture's moment but what the right camera sees, which is of its own.
struct SyntheticClipFrame {
  Pair pair;
  double t_s = 0;
  double ceiling_light = 1;                         // power of the lamp
  std::string act;                                  // what the person does
  std::vector<SyntheticJoint> joints;               // 49: of kBodyHands without spine, chest and a joint of each finger
  std::vector<std::vector<SyntheticJoint>> others;  // of other people, where the script has some
  Image<float> depth_left_m;                        // as in SyntheticPair
  Image<std::uint8_t> figure_left;                  // 255 where that is a person
};

/// A person before the rig does what a script says.
///
/// Frames can be asked for in any order; the same setup gives the same bits with any number of threads.
class SyntheticClip {
 public:
  /// The first frame renders the still room, too: some seconds at 640x480.
  ///
  /// Errors  unknown script, size or number of frames that cannot be
  static Result<SyntheticClip> open(const SyntheticClipSetup& setup, int threads);
  SyntheticClip(SyntheticClip&&) noexcept;
  ~SyntheticClip();

  const SyntheticClipSetup& setup() const;  // frames and arm as they were chosen
  const Rig& rig() const;
  SyntheticClipFrame frame(int index);

  /// What an undistorted pinhole camera in the left one's place, with its focal lengths and centre, would show.
  struct Pinhole {
    Image<float> depth_m;
    Image<std::uint8_t> figure;
  };
  Pinhole pinhole(int index);

  /// Flesh and cloth that may lie in front of a visible joint.
  static double tolerance_m(JointId joint);

 private:
  struct State;
  explicit SyntheticClip(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Of a person that stands before the rig and moves an arm: wave, reach, sweep, behind, out, light, and tour, which is all of
/// these one after the other; pinch, in which thumb and index finger meet. Of whole bodies, of other sizes and clothes, farther
/// away: turn once around; walk across and back; sit down and cross the legs; cross, in which a second person comes the other
/// way.
std::vector<std::string> synthetic_scripts();

/// Renders a clip into a new folder: left.avi and right.avi (MJPEG), calibration_truth.yml, truth.json, and every tenth frame
/// depth/depth_NNNN.png (0.1 mm, ideal pinhole camera) with its mask depth/figure_NNNN.png. The folder appears whole or not
/// at all; an earlier clip of that name is replaced. Where `progress` says false the clip ends with that frame.
///
/// Errors  those of SyntheticClip::open(); the name is taken by something else; a file cannot be written
Result<void> write_clip(const SyntheticClipSetup& setup, const std::filesystem::path& folder, int threads,
                        const std::function<bool(int done, int frames)>& progress);

}  // namespace duo
