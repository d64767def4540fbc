// True disparity of one's own desk, by structured light: patterns from a projector tell both cameras which of its pixels lights
// what they see.
//
// Source  Scharstein, Szeliski, "High-accuracy stereo depth maps using structured light", 2003. As there, each stripe pattern
//         has its inverse, both directions are coded, and both views are compared with each other alone: where the projector
//         stands need not be known. The sine's phase is taken from eight steps here, whose sums the first six harmonics of an
//         unknown response to light do not change.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/source.h"

namespace [[gnu::visibility("default")]] duo {

/// What a projector shows: for columns, then for rows, stripes of half a period in Gray code and a sine of that period.
struct LightCode {
  Size screen = {1920, 1080};  // of the projector, px
  int period_px = 32;          // of the sine, even; the Gray code's finest stripes are half as wide
  friend bool operator==(const LightCode&, const LightCode&) = default;
};

/// Refuses what no projector shows.
///
/// Errors  screen outside 16 .. 16384 px a side; period not even, or outside 8 .. 256 px
Result<void> check_light_code(const LightCode& code);

inline constexpr int kPhaseSteps = 8;

struct LightPattern {
  enum class Kind : std::uint8_t {
    kLight,    // black: the scene in its ordinary light
    kStripes,  // a bit of the Gray code
    kInverse,  // the same with black and white exchanged
    kSine
  };
  Kind kind = Kind::kLight;
  bool rows = false;  // what is coded: columns, or rows
  int number = 0;     // bit of the Gray code, the coarsest first; or step of the sine
  friend bool operator==(const LightPattern&, const LightPattern&) = default;
};

/// All patterns in the order in which they are shown: the ordinary light; of columns each bit and its inverse, then the sine's
/// steps; the same of rows.
std::vector<LightPattern> light_patterns(const LightCode& code);

/// "stripes 3 of 7 of columns, inverse"
std::string describe_pattern(const LightCode& code, const LightPattern& pattern);

/// Shape   code.screen
/// Units   0 black .. white; `white` below 255 dims all patterns, for scenes that would be saturated
Image<std::uint8_t> draw_pattern(const LightCode& code, const LightPattern& pattern, int white = 255);

/// patterns.json: {"schema": "duoptic.patterns", "version": 1, "screen": [W, H], "period_px": P}
///
/// Errors  not there, not such a file; what check_light_code() refuses
Result<LightCode> load_light_code(const std::filesystem::path& path);
std::string json_from_light_code(const LightCode& code);

/// The pictures of one exposure, left_000.png and right_000.png on: of any kind that open_source() reads.
struct LightFiles {
  std::filesystem::path left, right;
};
/// Of all patterns, in their order.
///
/// Errors  not a folder; a picture that is missing; more pictures than patterns
Result<std::vector<LightFiles>> find_light_files(const std::filesystem::path& folder, const LightCode& code);
/// "left_007.png"
std::string light_file_name(bool is_left, std::size_t pattern);

// --- Recording -----------------------------------------------------------------------------------------------------------

/// Where patterns are shown.
class LightScreen {
 public:
  virtual ~LightScreen() = default;
  /// Returns when the screen has been told to show it. False: its user wants no more.
  ///
  /// Errors  the screen is gone
  virtual Result<bool> show(View<const std::uint8_t> picture) = 0;
};

struct LightRecording {
  int average = 4;         // pictures per pattern, of which the mean is kept
  int white = 255;         // see draw_pattern()
  double warm_up_s = 2.5;  // of gray, in which cameras find and lock their exposure
  double most_s = 5;       // for a pattern to be seen and to come to rest
};

/// Shows all patterns and gives what the cameras see of each. A pattern's pictures count once they differ from the one before
/// and no longer from each other, by more than they do while nothing changes: so neither the screen's delay nor the cameras'
/// needs to be known.
///
/// keep    is called once per pattern, in order, with the mean pictures
/// Errors  a source that is not live, or ends; a pattern that is not seen; pictures that do not come to rest; those of the
///         source, the screen and `keep`; the user ends it
Result<void> record_light(PairSource& pairs, const LightCode& code, const LightRecording& how, LightScreen& screen,
                          const std::function<Result<void>(std::size_t pattern, const Pair& pair)>& keep);

// --- Decoding ------------------------------------------------------------------------------------------------------------

/// What the pixels of one raw picture are told.
struct LightCounts {
  std::int64_t pixels = 0;
  std::int64_t known = 0;      // of these, with a place on the projector
  std::int64_t saturated = 0;  // too bright in every exposure
  std::int64_t unlit = 0;      // too dark: in shadow, out of the projector's reach, or black
  std::int64_t uncertain = 0;  // lit, but stripes and phase do not tell the same, or a bit is in doubt
};

/// Disparity of the rectified pair where both views are lit by the same pixel of the projector.
///
/// Shape  all H x W of the rectified pair
struct LightTruth {
  static constexpr int kMostDisparity_px = 2000;  // below Engine::kMaxDisparity, and in 16 bits at 1/32 px
  Pair pair;                                      // rectified, in ordinary light
  std::optional<Rectified> rectified;             // none: the pair was rectified already
  Image<float> disparity_px;                      // x_left - x_right, above 0; 0 = unknown
  LightCounts left, right;
  std::int64_t inside = 0;         // pixels of the rectified left view that its raw picture covers
  std::int64_t matched = 0;        // of these, with a disparity
  std::int64_t contradicting = 0;  // pixels whose match, looked for from the other side, lies elsewhere
  double rows_px = 0;              // median of how much lower the right view shows what the left one does: 0 of a rig that fits
};

/// Takes exposures one by one: all patterns each, as the cameras saw them.
class LightDecoder {
 public:
  /// No rig: the pairs are rectified.
  ///
  /// Errors  those of check_light_code() and of every rig; a rig of pictures of another size
  static Result<LightDecoder> open(const LightCode& code, const std::optional<Rig>& rig, Size raw, int threads);
  LightDecoder(LightDecoder&&) noexcept;
  LightDecoder& operator=(LightDecoder&&) noexcept;
  ~LightDecoder();

  /// The next pattern's pair, in the order of light_patterns(); after the last one the next exposure begins. Each pixel takes
  /// the exposure in which the sine is the clearest.
  ///
  /// Errors  pictures of another size
  Result<void> add(const Pair& pair);
  /// After one or more whole exposures. `light`: the raw pair to keep as the scene's; none: what the first pattern saw.
  ///
  /// Errors  no whole exposure; a light pair of another size; nothing that both views see is lit
  Result<LightTruth> truth(const Pair* light = nullptr) const;

 private:
  struct State;
  explicit LightDecoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a scene that load_scene() and `duoptic eval middlebury` read: left.png, right.png, disp_left.png (16 bits, 1/32 px),
/// meta.json, and disparity.png, in colours to look at. The files appear together or not at all.
///
/// Errors  those of every written file
Result<void> write_scene(const LightTruth& truth, const std::filesystem::path& folder);

// --- Folders -------------------------------------------------------------------------------------------------------------

/// How many of all are done; false: its user wants no more. That is an error, and nothing was written.
using LightProgress = std::function<bool(std::size_t done)>;

inline constexpr const char* kLightCodeFile = "patterns.json";

/// pattern_000.png on and patterns.json, to be shown by other means. They appear when all is done.
///
/// Errors  those of check_light_code() and of every written file
Result<void> write_light_patterns(const LightCode& code, int white, const std::filesystem::path& folder,
                                  const LightProgress& progress);

/// record_light() into a folder: left_000.png and right_000.png on, and patterns.json. They appear when all is done.
///
/// Errors  those of record_light() and of every written file
Result<void> record_light_folder(PairSource& pairs, const LightCode& code, const LightRecording& how, LightScreen& screen,
                                 const std::filesystem::path& folder, const LightProgress& progress);

/// Folders of recorded pictures, exposures of the same scene.
struct LightFolders {
  std::vector<std::string> folders;     // one or more
  std::vector<std::string> light = {};  // left and right picture in ordinary light; none: those of the black pattern
  std::optional<Rig> rig = {};          // none: the pictures are rectified
  int threads = 1;
};
/// Errors  no folder; pictures in ordinary light that are neither none nor two; those of find_light_files(), of every picture
///         and of LightDecoder
Result<LightTruth> decode_light_folders(const LightCode& code, const LightFolders& what, const LightProgress& progress);

}  // namespace duo
