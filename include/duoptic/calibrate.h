// Calibration: pictures of a board in, a rig out that says how good it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "duoptic/board.h"
#include "duoptic/frame.h"
#include "duoptic/rig.h"
#include "duoptic/source.h"

namespace [[gnu::visibility("default")]] duo {

/// Pairs of pictures of a board: from two folders, or the still moments of two videos.
class BoardPictures {
 public:
  /// Two folders pair by the last numbers in their files' names, or by what differs within each; an empty `right` is the same
  /// folder, which then has both, told by "left" and "right" in their names, or pictures that hold both views each. Two videos
  /// give of every third of a second the stillest pair.
  ///
  /// Errors  those of sources; folders without pictures, or whose pictures do not pair
  static Result<BoardPictures> open(const std::filesystem::path& left, const std::filesystem::path& right,
                                    const PairWish& wish = {});

  std::int64_t count() const;
  /// False at the end. `name` says which pair it is, in words.
  ///
  /// Errors  those of Source::next()
  Result<bool> next(Pair& into, std::string& name);
  std::string warning() const { return video_ ? video_->warning() : ""; }
  /// A video was cut short.
  bool cut() const { return cut_; }

 private:
  Result<bool> next_still(Pair& into, std::string& name);

  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> files_;
  std::size_t at_ = 0;
  PairWish wish_;
  std::unique_ptr<PairSource> video_;
  Pair before_;
  std::int64_t frame_ = 0;
  bool cut_ = false;
};

/// A corner of the board in a picture.
struct BoardCorner {
  int id = 0;
  double x_px = 0, y_px = 0;
  double dx_px = 0, dy_px = 0;  // after calibration: seen minus predicted
};

/// One pair of pictures with a board in it.
struct BoardView {
  std::string name;
  std::vector<BoardCorner> left, right;  // in order of their ids; empty where the board was not found
  double sharp_px = 0;                   // how far an edge of the board is spread, the worse of both pictures
  bool used = false;                     // by the calibration
  bool rejected = false;                 // by it, because it does not fit the others
  std::string why_not;                   // one line when it was not
};

struct Calibration {
  Rig rig;
  std::vector<BoardView> views;  // all in which a board was found
  double held_out_shape_m = 0;   // held-out boards measured with the rig: rms distance of their corners from the true shape,
  double held_out_z_m = 0;       // and how far they were, on average
  std::vector<std::string> warnings;  // what to know before trusting it, one line each, and what to do; none = good
};

/// Cells of a camera's picture, row by row, that have corners.
inline constexpr Size kCoverageSize = {12, 9};
using Coverage = std::array<bool, std::size_t{12} * 9>;

/// Collects views of a board, from files or from live cameras alike, and calibrates.
///
/// Corners are OpenCV's, made exact by our own refinement; each camera is first calibrated alone (Zhang, 2000, OpenCV's
/// calibrateCamera), then everything at once: both lenses, the pose between them and the board's pose in every view, by a
/// bundle adjustment that gives less weight to corners that do not fit (Huber), rejects views that do not, and has one noise
/// level a camera. The uncertainty is the covariance of that adjustment, scaled by its residuals (Hartley & Zisserman,
/// "Multiple View Geometry", ch. 5.2 and A6). It assumes that corners err independently. A second one does not, the jackknife
/// over views (Efron & Stein, "The jackknife estimate of variance", 1981): how far the result moves when each view is left out.
/// Of each quantity the larger of the two is given. Neither knows of a print whose squares are not as large as said.
class Calibrator {
 public:
  Calibrator(const Board& board, Size size);
  Calibrator(Calibrator&&) noexcept;
  ~Calibrator();

  /// Looks for the board in both pictures and keeps what it finds.
  ///
  /// Errors  the pictures do not have the size of the first; the first that look like a board show another one than named
  Result<const BoardView*> add(const Pair& pair, const std::string& name);

  /// The same in two steps, for whoever keeps only some of the views. look() gives a board up soon that only a long search
  /// would find, and takes tens of milliseconds at 640x480. The pictures must have the size of the calibrator.
  BoardView look(const Pair& pair, const std::string& name) const;
  const BoardView* keep(BoardView view);
  /// Another side of the squares, also of the views that were kept.
  void set_square_m(double square_m);

  int pairs() const;  // added or kept
  const std::vector<BoardView>& views() const;

  /// Where a camera's picture (0 left, 1 right) has corners, and in what share of it.
  Coverage covered(int camera) const;
  double coverage(int camera) const;

  /// Errors  one line that says what is missing or wrong: too few views, all of one pose, blurred, another board than named,
  /// left and right swapped, a mirrored picture, pairs that do not belong together, a fit too bad to be used
  Result<Calibration> solve() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// How many disparities to search, from 0, so that depth begins at `near_m`: a multiple of 16, as many as matchers compare at
/// once.
///
/// Errors  those of every rig; near_m not above zero
Result<int> disparities_from(const Rig& rig, double near_m);

/// What the search for people needs: disparities_from() half a metre, but no more than 256, as every matcher takes them: a
/// large picture starts at a greater depth.
///
/// Errors  those of every rig
inline constexpr double kNearestPeople_m = 0.5;
inline constexpr int kMostPeopleDisparities = 256;
Result<int> disparities_for_people(const Rig& rig);

/// What a rig can do, for its user.
struct RigDescription {
  double common_degrees = 0;  // width of what both cameras see at 2 m
  double common_share = 0;    // of the left picture that the right camera sees, too, at 2 m
  Size rectified;             // size of the rectified pictures
  int max_disparity = 0;      // disparities_from() `near_m`
  double near_m = 0;
  std::array<double, 3> step_m{};  // by how much depth changes with a quarter pixel of disparity, at 1, 2 and 3 m
};

/// Errors  those of every rig; near_m not above zero
Result<RigDescription> describe_rig(const Rig& rig, double near_m);

/// The report with its plots: one HTML file that needs nothing else. `shown` is a pair of the calibrated cameras, of which the
/// rectified pictures are shown.
///
/// Errors  those of rectify_pair() and of every written file
Result<void> write_calibration_report(const Calibration& calibration, const Board& board, const RigDescription& can,
                                      const Pair& shown, const std::filesystem::path& path);

/// Both pictures rectified, in colour, black where a raw picture does not reach.
///
/// Errors  those of every rig; pictures of another size
Result<Pair> rectify_pair(const Rig& rig, const Pair& pair);

}  // namespace duo
