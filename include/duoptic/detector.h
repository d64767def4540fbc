// Detectors find people, the points of their bodies and of their hands in one picture. All numbers are integers: a tracker that
// chooses the next region by the last result stays the same to the last bit on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/geometry.h"
#include "duoptic/image.h"
#include "duoptic/result.h"
#include "duoptic/window.h"

namespace [[gnu::visibility("default")]] duo {

/// Points of a body, left and right as the person says it. The numbers are BlazePose's.
enum class BodyPoint : std::uint8_t {
  kNose,
  kLeftEyeInner,
  kLeftEye,
  kLeftEyeOuter,
  kRightEyeInner,
  kRightEye,
  kRightEyeOuter,
  kLeftEar,
  kRightEar,
  kMouthLeft,
  kMouthRight,
  kLeftShoulder,
  kRightShoulder,
  kLeftElbow,
  kRightElbow,
  kLeftWrist,
  kRightWrist,
  kLeftPinky,
  kRightPinky,
  kLeftIndex,
  kRightIndex,
  kLeftThumb,
  kRightThumb,
  kLeftHip,
  kRightHip,
  kLeftKnee,
  kRightKnee,
  kLeftAnkle,
  kRightAnkle,
  kLeftHeel,
  kRightHeel,
  kLeftFootIndex,
  kRightFootIndex,
};
inline constexpr std::size_t kBodyPoints = 33;
std::string_view name_of(BodyPoint point);  // "left_shoulder"

/// Points of a hand: the wrist, then four of each finger from its root to its tip, the thumb first. The numbers are
/// MediaPipe's.
inline constexpr std::size_t kHandPoints = 21;
std::string_view hand_point_name(std::size_t point);  // "index_tip"

/// A turned square of a picture.
///
/// Units  1/256 px; the centre of the top left pixel is (0, 0)
struct TurnedSquare {
  std::int32_t x_q8 = 0, y_q8 = 0;              // its centre
  std::int32_t right_x_q8 = 0, right_y_q8 = 0;  // from there to the middle of its right side
  friend bool operator==(const TurnedSquare&, const TurnedSquare&) = default;
};

/// A point as a network sees it.
///
/// Units  x, y: 1/256 px of the picture; z: the same, away from the camera, from the middle of the hips (of a hand: from its
///        wrist); world: 1/65536 m from the same middle, x right and y down in the picture, z away; visible, present: 1/32768
struct SeenPoint {
  std::int32_t x_q8 = 0, y_q8 = 0, z_q8 = 0;
  std::array<std::int32_t, 3> world_q16 = {};
  std::uint16_t visible_q15 = 0;  // in the picture and not hidden
  std::uint16_t present_q15 = 0;  // in the picture

  double x_px() const { return x_q8 / 256.0; }
  double y_px() const { return y_q8 / 256.0; }
  double visibility() const { return visible_q15 / 32768.0; }
  Vec3 world_m() const { return {world_q16[0] / 65536.0, world_q16[1] / 65536.0, world_q16[2] / 65536.0}; }
};

/// Where a person may be.
struct FoundPerson {
  TurnedSquare region;          // for Detector::bodies()
  std::uint16_t score_q15 = 0;  // 1/32768
};

struct SeenBody {
  std::uint16_t score_q15 = 0;  // that there is a body in the region, 1/32768
  std::array<SeenPoint, kBodyPoints> points = {};
  TurnedSquare next;  // where to look in the next picture

  const SeenPoint& at(BodyPoint point) const { return points[static_cast<std::size_t>(point)]; }
};

struct SeenHand {
  std::uint16_t score_q15 = 0;                     // that there is a hand in the region, 1/32768
  std::uint16_t right_q15 = 0;                     // that it is a right hand
  std::array<SeenPoint, kHandPoints> points = {};  // visible and present are 1: the network does not say
};

/// A part of a picture to look at.
struct Look {
  View<const Rgb8> picture;
  TurnedSquare region;
};

/// Finds people and their points. Looks at several regions, of one or several pictures, in one call.
///
/// Threads  one caller at a time
class Detector {
 public:
  virtual ~Detector() = default;
  /// People in a part of the picture, best first, each once. People less than a seventh as tall as the part are missed.
  /// Valid until the next call.
  virtual std::span<const FoundPerson> find(View<const Rgb8> picture, Window part) = 0;
  /// Shape  out as many as looks
  virtual void bodies(std::span<const Look> looks, std::span<SeenBody> out) = 0;
  virtual void hands(std::span<const Look> looks, std::span<SeenHand> out) = 0;
  /// Whether hands() can be asked.
  virtual bool sees_hands() const = 0;
};

enum class BodyModel : std::uint8_t { kLite, kFull, kHeavy };
inline constexpr std::array<std::string_view, 3> kBodyModelNames = {"lite", "full", "heavy"};

struct DetectorOptions {
  BodyModel body = BodyModel::kFull;
  bool hands = false;  // with body kLite the hand's smaller network, too
  bool plain = false;  // on plain loops, slowly: the definition
  std::optional<std::string> device =
      {};  // a Vulkan device by its index or name, empty: the graphics card; none: the processor
  int threads = 1;
  std::filesystem::path models = {};  // folder of the networks; empty: models_folder()
};

/// The folder of the networks: $DUOPTIC_MODELS, or the one that was installed with the library, or the source's.
std::filesystem::path models_folder();

/// Errors  a network is missing (how to get it), broken, cut, or another network than its name says; no such device
Result<std::unique_ptr<Detector>> make_detector(const DetectorOptions& options);

/// Where to look for a hand: around its knuckles, 30 cm wide at the body's scale, fingers up. None when it is outside the
/// picture.
std::optional<TurnedSquare> hand_region(const SeenBody& body, bool left, Size picture);

/// A person with everything that was asked for.
struct SeenPerson {
  SeenBody body;
  std::optional<SeenHand> left_hand, right_hand;
  Window box_px;  // around the points that are probably visible; of none, around all
};

/// People in picture after picture: whom it saw it follows, and looks for others in the whole picture and in its parts.
///
/// Threads  one caller at a time
class PeopleFinder {
 public:
  struct Options {
    bool hands = false;
    std::size_t most = 8;  // people
    int search_every = 4;  // pictures, while somebody is followed
  };
  PeopleFinder(Detector& detector, const Options& options);
  ~PeopleFinder();

  /// One picture by itself: every part is searched. Valid until the next call.
  std::span<const SeenPerson> look(View<const Rgb8> picture);
  /// The next picture of a video: those seen before are followed, and one part is searched. `also`: where somebody may be who
  /// was not seen in the last picture. Valid until the next call.
  std::span<const SeenPerson> follow(View<const Rgb8> picture, std::span<const TurnedSquare> also = {});

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace duo
