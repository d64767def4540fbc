// Sources give pictures, from files or as they are taken. Pairs come from two sources or from one with both views side by side.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"

namespace [[gnu::visibility("default")]] duo {

enum class Next : std::uint8_t {
  kNew,      // a new picture, pair or frame
  kEnd,      // no more
  kCut,      // no more, but the file says there should be: it was cut short; all whole pictures were given
  kNothing,  // live: none came for a while, a camera may be unplugged; ask again
};

/// One camera, live or recorded.
class Source {
 public:
  virtual ~Source() = default;
  virtual Size size() const = 0;
  /// How many pictures it will give; 0 = not known.
  virtual std::int64_t count() const = 0;
  /// True for one picture, false for a stream of them.
  virtual bool still() const = 0;
  /// Mean time between pictures, seconds; 1/30 where nothing is known.
  virtual double frame_s() const { return 1.0 / 30; }
  /// True when pictures come as they are taken: next() then waits a second at most, and gives the newest.
  virtual bool live() const { return false; }
  /// Live: pictures that were lost on the way or that nobody took in time; any thread may ask.
  virtual std::int64_t dropped() const { return 0; }
  /// Live: what there is to say of the camera now (away since when, back again, cannot be locked); any thread may ask. Of a
  /// file: how many of its pictures were damaged and left out so far, that it is interlaced, that a picture file holds more of
  /// them than the one that is used.
  virtual std::string warning() const { return {}; }
  /// Fills `into` with the next picture; its memory is used again when it already has the right size.
  virtual Result<Next> next(Picture& into) = 0;
};

/// What is asked of live cameras. Files and network streams have what they have.
struct CameraWish {
  Size size = {640, 480};
  double rate_hz = 30;
};

/// Where both views lie in the pictures of one source; the first named is the left half, or the upper one.
enum class ViewLayout : std::uint8_t { kSideBySide, kRightLeft, kTopBottom, kBottomTop };
inline constexpr std::array<std::string_view, 4> kViewLayoutNames = {"side-by-side", "right-left", "top-bottom", "bottom-top"};

/// What is asked of two cameras, and what is known of files that they do not say themselves.
struct PairWish {
  CameraWish cameras = {};                // its size is that of one view, also of a camera that gives both in one picture
  TimeNs skew_ns = 0;                     // of two videos: how much later than their times say the right pictures were taken
  std::optional<ViewLayout> layout = {};  // of one source; none: what it says itself, else side by side where both halves agree
};

/// Pictures of files and streams with more pixels than this are refused, before they are decoded where the file says its size;
/// kMostPixels unless told. For the whole process, at any time.
void limit_pictures(std::int64_t most_pixels);
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 26;  // 8192 x 8192

/// Opens a picture (PNG, JPEG, … one picture), a video file (JPEGs one after the other are one, too), a camera (camera:0,
/// /dev/video0, camera:BUS_PATH) or a stream (http://, https://, rtsp://, gst:PIPELINE). Pictures come upright, as EXIF's
/// orientation and a video's display matrix ask; of 16 bits the eight highest that are used.
///
/// Errors  missing, empty, not a picture or video, unreadable at its start, too many pixels; a camera that cannot be opened,
/// that does not give
///         the wished size, or that finds no room on its bus
Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path, const CameraWish& wish = {});

/// Reads a gray PNG with all its bits; the values of one of 8 bits stay what they are, one bit is 0 or 255.
///
/// Errors  not there, not a whole PNG, coloured, more than 256 MiB
Result<Image<std::uint16_t>> read_png16(const std::filesystem::path& path);

/// Two views as one stream of pairs, each exactly once.
class PairSource {
 public:
  virtual ~PairSource() = default;
  virtual Size size() const = 0;  // of one view
  virtual std::int64_t count() const = 0;
  virtual bool still() const = 0;
  virtual double frame_s() const { return 1.0 / 30; }
  /// The rig that the pairs were taken with, when the source knows it.
  virtual std::optional<Rig> rig() const { return std::nullopt; }
  /// Files wait: each pair is given. Live ones do not: next() waits, a second at most, for a pair that was not given yet, and
  /// gives the newest.
  virtual bool live() const { return false; }
  /// Pairs of a live source that nobody took in time; any thread may ask.
  virtual std::int64_t dropped() const { return 0; }
  /// Picture::t_ns counts from the start of a file; live, it is the steady clock's time of capture.
  virtual Result<Next> next(Pair& into) = 0;
  /// After the end: why the stream ended before its files did (one was cut short, or is shorter), and which pictures were left
  /// out, damaged or without a partner; empty when there is nothing to say. Live, any thread at any time: what
  /// Source::warning() says of both.
  virtual std::string warning() const = 0;
};

/// Opens LEFT and RIGHT (two pictures, two videos or two live sources of the same size); an empty `right` means that `left`
/// holds both views: as two video tracks, of which a recording may bring its rig, as the two pictures of an MPO, or as halves
/// of each picture. A recording that was killed or cut gives its whole pairs and then Next::kCut. Two cameras share exposure,
/// gain and white balance: the left one's, after a second. "synthetic", "synthetic:SCRIPT", "synthetic:SCRIPT:WIDTHxHEIGHT" or
/// "synthetic:SCRIPT:WIDTHxHEIGHT:PAIRS" alone is the person of `duoptic synth`, live: that many pairs forth and back, 60 when
/// not said.
///
/// Videos pair by their times, as cameras do: each picture with the nearest of the other camera within half the time from one
/// picture to the next. Two pictures of 10 to 16 bits are scaled alike.
///
/// Errors  those of open_source(); a recording's rig that cannot be one; sizes differ; a picture and a video, a file and a live
///         source, one camera twice; a layout, or a skew, for what has none; halves of odd size. From next(): halves that have
///         nothing in common, videos without a picture that pairs
Result<std::unique_ptr<PairSource>> open_pairs(const std::filesystem::path& left, const std::filesystem::path& right,
                                               const PairWish& wish = {});

/// Pairs with the rig that they are seen with.
struct Input {
  std::unique_ptr<PairSource> pairs;
  std::optional<Rig> rig;
  std::vector<std::string> names;  // as the user wrote them, left first
};

/// Opens LEFT and perhaps RIGHT. `rig` wins over the source's own, and cameras are asked for the size that it was made for.
///
/// Errors  those of open_pairs(); half of LEFT alone is half of what the rig was made for: RIGHT is missing
Result<Input> open_input(const std::string& left, const std::string& right, const std::optional<Rig>& rig, PairWish wish = {});

/// The pairs of files at the pace of their capture times, as if they came live: one that is late is dropped when the next is
/// due, too.
std::unique_ptr<PairSource> in_real_time(std::unique_ptr<PairSource> pairs);

}  // namespace duo
