// The engine turns a pair into a frame: denoise, rectify, match, check, depth.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/row_offsets.h"
#include "duoptic/window.h"

namespace [[gnu::visibility("default")]] duo {

enum class Denoise : std::uint8_t {
  kAuto,  // kGaussian for raw pictures (with a rig), kNone for pairs that come rectified
  kNone,
  kMedian,     // median 3x3
  kGaussian,   // 5x5 binomial
  kBoth,       // median, then Gaussian: the thesis
  kDiffusion,  // anisotropic diffusion: smooths surfaces, keeps their edges; not on a device
};

/// Which full maps the frame shall hold. CPU engines have those that are on here in any case; a device sends only what is
/// wanted.
struct Wants {
  bool color = false;       // the rectified left picture in colour
  bool depth = false;       // depth_mm; needs a rig
  bool confidence = false;  // how sure each disparity is; of the matcher sgm alone
  bool views = true;        // left and right, and where they are inside
  bool disparity = true;
  bool on_device = false;  // left, color and disparity stay on the device; an engine on the CPU gives them as maps
};

struct Setup {
  Size size;                       // of each raw picture
  std::optional<Rig> rig;          // none: the pair is taken as rectified
  std::optional<RowOffsets> rows;  // of such a pair: are taken off the right picture
  std::string matcher = "sgm";
  std::string preset = "default";
  std::vector<std::pair<std::string, double>> parameters;  // override the preset's, by name (see matcher_parameters)
  int max_disparity = 128;                                 // searches [0, max_disparity) px
  bool fill = false;                                       // fill holes from the background
  Denoise denoise = Denoise::kAuto;
  Wants wants;
  bool many_at_once = false;  // threads of the CPU make frames of their own, several at once: more of them, each later
  bool time_stages = false;
  /// How much of the frame in work is done, 0 .. 1, from matchers that take seconds (fine), where no others are made meanwhile.
  /// Called in the thread of submit().
  std::function<void(double done)> progress = {};
};

/// A part of a frame: a window of the left rectified picture, and the disparities in it.
///
/// Units  px; disparities [begin, end)
struct Focus {
  Window window;  // empty: the whole picture, and all disparities
  int disparity_begin = 0, disparity_end = 0;
  int row_step =
      1;  // of the window's rows each row_step-th is matched, by matchers that can; the others follow those beside them
  friend bool operator==(const Focus&, const Focus&) = default;
};

/// Turns pairs into frames, in order: submit, collect, submit, … A device that is lost on the way is replaced by the CPU: no
/// frame is missing, and take_event() tells.
///
/// Errors   all that can fail is in prepare(); after a failed prepare() the engine is as it was
/// Threads  one caller
class Engine {
 public:
  static constexpr int kMaxDisparity = 2048;
  static constexpr int kSpareFrames = 3;  // one that waits, one that is tracked, one that is shown
  virtual ~Engine() = default;
  virtual const char* name() const = 0;
  virtual Result<void> prepare(const Setup& setup) = 0;
  /// How many pairs may be submitted before the first of them is collected, once prepare() was called.
  virtual int in_flight() const { return 1; }
  /// Only these windows of the left rectified picture matter from the next submit() on; none: all of it. Inside them disparity,
  /// origin, confidence and depth are the same, bit for bit, as of the whole picture; outside there are none. Engine simd with
  /// matcher sgm leaves out the rows they do not depend on; where all is computed anyway they only cut it out.
  virtual void look_at(std::span<const Window> windows) = 0;
  /// From the next submit() on only this window is matched, and in it only these disparities; outside there are none, and
  /// nothing is filled. What is not matched costs nothing; in return values are not those of the whole picture: paths begin at
  /// the window's border. The same bits on every engine that can_focus(); on a device the CPU makes all frames from the first
  /// call on, until the next prepare(). Takes the place of look_at().
  virtual void focus(const Focus&) {}
  virtual bool can_focus() const { return false; }
  /// Starts work on a pair of the size given to prepare(); the pair must live until its collect() returns.
  virtual void submit(const Pair& pair) = 0;
  /// The finished frame of the oldest pair submitted. It belongs to whoever has its pointer, in any thread, and outlives the
  /// engine. prepare() makes in_flight() + kSpareFrames frames, whose memory is used over and over; while all of them are held,
  /// one more is made, and stays.
  virtual std::shared_ptr<const Frame> collect() = 0;
  /// The device that computes, where that is not the CPU.
  virtual std::string device() const { return {}; }
  /// What happened since the last call that the user should know, in one line; else empty.
  virtual std::string take_event() { return {}; }
  /// The geometry of the frames; empty before prepare() and without a rig.
  virtual const std::optional<Rectified>& rectified() const = 0;
};

/// Makes an engine by name: "ref" (plain loops: the definition), "simd" (fast, same bits), "vulkan" (the graphics card, same
/// bits; "vulkan:0" or "vulkan:radeon" names the device by index or a part of its name), "auto" (the graphics card if it has
/// all that is needed, else simd).
///
/// Errors  unknown name, with the known ones; no such device, with what there is
Result<std::unique_ptr<Engine>> make_engine(std::string_view name, int threads);

/// The names that Setup::matcher takes, and the presets of one of them.
std::vector<std::string> matcher_names();
std::vector<std::string> matcher_presets(std::string_view matcher);

struct ParameterInfo {
  std::string name, unit, help;
  double value = 0, min = 0, max = 0;
};
/// Every parameter of a matcher with its value in `preset`.
///
/// Errors  unknown matcher or preset
Result<std::vector<ParameterInfo>> matcher_parameters(std::string_view matcher, std::string_view preset);

}  // namespace duo
