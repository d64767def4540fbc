// A live calibration that is led: which view of the board is wanted next, when a pair is taken, when there are enough.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/calibrate.h"

namespace [[gnu::visibility("default")]] duo {

/// What the views of a board must have together so that they determine both lenses and the pose between them. "Upper left" and
/// so on: the board covers the middle of that ninth of either picture. A side "nearer": by 15 degrees or more, as the left
/// picture shows it. "Near" and "far": the corners cover an eighth of the left picture, or less than a twentieth.
enum class BoardWish : std::uint8_t {
  kMiddle,
  kLeftNearer,
  kRightNearer,
  kTopNearer,
  kBottomNearer,
  kUpperLeft,
  kUpperRight,
  kLowerRight,
  kLowerLeft,
  kTop,
  kRight,
  kBottom,
  kLeft,
  kNear,
  kFar
};
inline constexpr std::size_t kBoardWishes = 15;
using BoardWishes = std::array<bool, kBoardWishes>;

/// "upper left".
const char* name_of(BoardWish wish);
/// How a wish is asked for: "now upper left".
const char* words_of(BoardWish wish);
/// Column and row, 0 .. 2, of the ninth of the picture where the board is wanted; none of wishes that are not about a place.
std::optional<std::array<int, 2>> ninth_of(BoardWish wish);

/// What a pose of the board has, told from one view without knowing the cameras.
struct BoardPlace {
  double left = 0, top = 0, right = 0, bottom = 0;  // of the corners' box, shares of the left picture
  double size = 0;                        // side of a square as large as the box, share of one as large as the picture
  double turned_deg = 0, tipped_deg = 0;  // left side nearer, top nearer: above 0
};

/// Takes a board that was found in the left picture. The angles are those for a camera that sees 53 degrees across.
///
/// Shape  four corners or more
BoardPlace place_of(const std::vector<BoardCorner>& corners, const Board& board, Size size);

enum class GuideStep : std::uint8_t {
  kShowBoard,  // to both cameras
  kOneCamera,  // only one of both sees it
  kBlurred,
  kHoldStill,  // this view is wanted
  kMove,       // to the view that is asked for
  kTaken,      // with this pair
  kEnough      // see CalibrationGuide::enough()
};

/// What was seen in a pair, and what to do now.
struct GuideLook {
  GuideStep step = GuideStep::kShowBoard;
  std::string words = {};                // of the step: one short line
  std::optional<BoardWish> wish = {};    // the next one, of those that are not met; none: all are
  bool perhaps_swapped = false;          // the board lies farther right in the right picture
  double held = 0;                       // kHoldStill: for what share of the time that a view is held
  std::vector<BoardCorner> left, right;  // the board, where it was found
};

/// Looks at pairs one after the other. A view is taken once the board stood still for half a second, which makes up for cameras
/// that do not expose at the same instant, and when it meets a wish or differs from all views before.
///
/// Threads  one caller
class CalibrationGuide {
 public:
  static constexpr int kFewestViews = 6, kMostViews = 40;

  CalibrationGuide(const Board& board, Size size);
  CalibrationGuide(CalibrationGuide&&) noexcept;
  CalibrationGuide& operator=(CalibrationGuide&&) noexcept;
  ~CalibrationGuide();

  /// Time is that of the left pictures. Tens of milliseconds at 640x480.
  GuideLook see(const Pair& pair);

  const Board& board() const;
  /// Also of the views that were taken.
  void set_square_m(double square_m);
  int views() const;
  /// All wishes are met, by ten views or more.
  bool enough() const;
  const BoardWishes& met() const;
  /// Calibrator::covered().
  Coverage covered(int camera) const;
  /// The pair that was taken with the largest board, for write_calibration_report().
  const Pair& shown() const;
  /// Errors  those of Calibrator::solve()
  Result<Calibration> solve() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The board that both pictures of a pair show, where it is another one than `named`; its squares are as large. Takes about a
/// second.
std::optional<Board> other_board(const Pair& pair, const Board& named);

}  // namespace duo
