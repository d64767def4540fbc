#include "duoptic/calibration_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "calib/find_board.h"
#include "calib/recognise_board.h"
#include "core/check.h"

namespace duo {
namespace {

constexpr double kTilt_deg = 15, kNearSize = 0.36, kFarSize = 0.22;
constexpr TimeNs kHeld_ns = 500'000'000, kLongestGap_ns = 400'000'000;
constexpr double kStill = 0.003, kOtherPlace = 0.08;  // mean way of the corners, share of the picture's width
constexpr double kOtherTilt_deg = 12;
constexpr double kSwapped = 0.03;  // share of the picture's width
constexpr std::size_t kGoodViews = 10;

constexpr std::array<const char*, kBoardWishes> kWords = {"show it in the middle",
                                                          "now turn its left side nearer",
                                                          "now turn its right side nearer",
                                                          "now tip its top nearer",
                                                          "now tip its bottom nearer",
                                                          "now upper left",
                                                          "now upper right",
                                                          "now lower right",
                                                          "now lower left",
                                                          "now to the top",
                                                          "now to the right",
                                                          "now to the bottom",
                                                          "now to the left",
                                                          "now nearer: half as wide as the picture",
                                                          "now farther away: a quarter as wide as the picture"};

constexpr std::array<const char*, kBoardWishes> kWishNames = {"middle",
                                                              "left side nearer",
                                                              "right side nearer",
                                                              "top nearer",
                                                              "bottom nearer",
                                                              "upper left",
                                                              "upper right",
                                                              "lower right",
                                                              "lower left",
                                                              "top",
                                                              "right",
                                                              "bottom",
                                                              "left",
                                                              "near",
                                                              "far"};

/// The ninth of the picture that a wish for a place is about: column and row, 0 .. 2.
constexpr std::array<std::pair<BoardWish, std::array<int, 2>>, 9> kNinths = {{{BoardWish::kMiddle, {1, 1}},
                                                                              {BoardWish::kUpperLeft, {0, 0}},
                                                                              {BoardWish::kUpperRight, {2, 0}},
                                                                              {BoardWish::kLowerRight, {2, 2}},
                                                                              {BoardWish::kLowerLeft, {0, 2}},
                                                                              {BoardWish::kTop, {1, 0}},
                                                                              {BoardWish::kRight, {2, 1}},
                                                                              {BoardWish::kBottom, {1, 2}},
                                                                              {BoardWish::kLeft, {0, 1}}}};

bool covers(const BoardPlace& place, const std::array<int, 2>& ninth) {
  const double x = (2 * ninth[0] + 1) / 6.0, y = (2 * ninth[1] + 1) / 6.0;
  return place.left <= x && x <= place.right && place.top <= y && y <= place.bottom;
}

BoardWishes met_by(const BoardPlace& left, const BoardPlace& right) {
  BoardWishes met{};
  const auto put = [&](BoardWish wish, bool is_met) { met[static_cast<std::size_t>(wish)] = is_met; };
  for (const auto& [wish, ninth] : kNinths) put(wish, covers(left, ninth) || covers(right, ninth));
  put(BoardWish::kLeftNearer, left.turned_deg >= kTilt_deg);
  put(BoardWish::kRightNearer, left.turned_deg <= -kTilt_deg);
  put(BoardWish::kTopNearer, left.tipped_deg >= kTilt_deg);
  put(BoardWish::kBottomNearer, left.tipped_deg <= -kTilt_deg);
  put(BoardWish::kNear, left.size >= kNearSize);
  put(BoardWish::kFar, left.size <= kFarSize);
  return met;
}

/// Mean way of the corners that both have, share of the picture's width; 1 without any. A chessboard may be numbered from its
/// other end.
double way(const std::vector<BoardCorner>& a, const std::vector<BoardCorner>& b, const Board& board, Size size) {
  double least = 1;
  for (const bool turned : {false, true}) {
    if (turned && board.kind != Board::Kind::kChessboard) continue;
    double sum_px = 0;
    int count = 0;
    for (const BoardCorner& c : a)
      for (const BoardCorner& d : b)
        if (c.id == (turned ? board.corners() - 1 - d.id : d.id))
          sum_px += std::hypot(c.x_px - d.x_px, c.y_px - d.y_px), ++count;
    if (count > 0) least = std::min(least, sum_px / count / size.width);
  }
  return least;
}

}  // namespace

const char* name_of(BoardWish wish) { return kWishNames[static_cast<std::size_t>(wish)]; }
const char* words_of(BoardWish wish) { return kWords[static_cast<std::size_t>(wish)]; }

std::optional<std::array<int, 2>> ninth_of(BoardWish wish) {
  const auto* const found = std::find_if(kNinths.begin(), kNinths.end(), [&](const auto& each) { return each.first == wish; });
  return found == kNinths.end() ? std::nullopt : std::optional(found->second);
}

BoardPlace place_of(const std::vector<BoardCorner>& corners, const Board& board, Size size) {
  DUO_CHECK(corners.size() >= 4);
  BoardPlace out{.left = 1e9, .top = 1e9, .right = -1e9, .bottom = -1e9};
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> in_picture;
  for (const BoardCorner& c : corners) {
    const double x = (c.x_px + 0.5) / size.width, y = (c.y_px + 0.5) / size.height;
    out.left = std::min(out.left, x), out.right = std::max(out.right, x);
    out.top = std::min(out.top, y), out.bottom = std::max(out.bottom, y);
    const Vec3 p_m = board.corner_m(c.id);
    on_board.emplace_back(p_m.x, p_m.y, 0);
    in_picture.emplace_back(c.x_px, c.y_px);
  }
  out.size = std::sqrt((out.right - out.left) * (out.bottom - out.top));
  const double focal_px = size.width;
  const cv::Matx33d camera(focal_px, 0, (size.width - 1) / 2.0, 0, focal_px, (size.height - 1) / 2.0, 0, 0, 1);
  cv::Vec3d turn, shift;
  try {
    // IPPE weighs both tilts that explain a small board, but divides by 0 where one lies on an axis of the picture.
    bool found = cv::solvePnP(on_board, in_picture, camera, cv::noArray(), turn, shift, false, cv::SOLVEPNP_IPPE);
    if (!found || !std::isfinite(cv::norm(turn)))
      found = cv::solvePnP(on_board, in_picture, camera, cv::noArray(), turn, shift);
    if (!found) return out;
    cv::Matx33d rotation;
    cv::Rodrigues(turn, rotation);
    // How depth grows to the right and downwards on the board's plane.
    const cv::Vec3d normal(rotation(0, 2), rotation(1, 2), rotation(2, 2));
    constexpr double kDegrees = 180 / std::numbers::pi;
    out.turned_deg = kDegrees * std::atan(-normal[0] / normal[2]);
    out.tipped_deg = kDegrees * std::atan(-normal[1] / normal[2]);
  } catch (const cv::Exception&) {  // corners on a line have no pose
  }
  return out;
}

struct CalibrationGuide::State {
  struct Taken {
    std::vector<BoardCorner> corners;
    BoardPlace place;
  };
  Board board;
  Size size;
  Calibrator calibrator;
  BoardWishes met{};
  std::vector<Taken> taken;
  std::optional<TimeNs> still_since_ns;
  TimeNs last_ns = 0;
  std::vector<BoardCorner> still_left, still_right;  // as they were then
  Pair shown;
  double shown_size = 0;

  State(const Board& of, Size of_size) : board(of), size(of_size), calibrator(of, of_size) {}

  std::optional<BoardWish> next_wish() const {
    for (std::size_t i = 0; i < met.size(); ++i)
      if (!met[i]) return static_cast<BoardWish>(i);
    return std::nullopt;
  }
  double held(const BoardView& view, TimeNs now_ns);
  bool adds(const BoardView& view, const BoardPlace& place, const BoardWishes& meets) const;
  void take(BoardView view, const BoardPlace& place, const BoardWishes& meets, const Pair& pair);
  void advise(GuideLook& look, GuideStep step) const;
};

/// For what share of the time that is asked for the board has not moved.
double CalibrationGuide::State::held(const BoardView& view, TimeNs now_ns) {
  const bool moved = !still_since_ns || now_ns - last_ns > kLongestGap_ns || now_ns < last_ns ||
                     way(view.left, still_left, board, size) > kStill || way(view.right, still_right, board, size) > kStill;
  last_ns = now_ns;
  if (moved) still_since_ns = now_ns, still_left = view.left, still_right = view.right;
  return std::min(1.0, static_cast<double>(now_ns - *still_since_ns) / static_cast<double>(kHeld_ns));
}

bool CalibrationGuide::State::adds(const BoardView& view, const BoardPlace& place, const BoardWishes& meets) const {
  if (taken.size() >= kMostViews) return false;
  for (std::size_t i = 0; i < meets.size(); ++i)
    if (meets[i] && !met[i]) return true;
  return std::none_of(taken.begin(), taken.end(), [&](const Taken& other) {
    return way(view.left, other.corners, board, size) < kOtherPlace &&
           std::hypot(place.turned_deg - other.place.turned_deg, place.tipped_deg - other.place.tipped_deg) < kOtherTilt_deg;
  });
}

void CalibrationGuide::State::take(BoardView view, const BoardPlace& place, const BoardWishes& meets, const Pair& pair) {
  for (std::size_t i = 0; i < meets.size(); ++i) met[i] |= meets[i];
  taken.push_back({view.left, place});
  calibrator.keep(std::move(view));
  if (place.size <= shown_size) return;
  shown_size = place.size;
  shown.left.pixels = pair.left.pixels.clone(), shown.right.pixels = pair.right.pixels.clone();
}

void CalibrationGuide::State::advise(GuideLook& look, GuideStep step) const {
  look.wish = next_wish();
  const bool enough = !look.wish && taken.size() >= kGoodViews;
  look.step = enough && step != GuideStep::kTaken ? GuideStep::kEnough : step;
  const char* const next = look.wish ? words_of(*look.wish) : "now anywhere else, tilted another way";
  switch (look.step) {
    case GuideStep::kShowBoard:
      look.words = fmt::format("Show the board ({}) to both cameras", board.name());
      break;
    case GuideStep::kOneCamera:
      look.words = look.right.empty() ? "Only the left camera sees the board: move it right, or farther away"
                                      : "Only the right camera sees the board: move it left, or farther away";
      break;
    case GuideStep::kBlurred:
      look.words = "Blurred: hold it still; more light, or another focus";
      break;
    case GuideStep::kHoldStill:
      look.words = "Hold still";
      break;
    case GuideStep::kMove:
      look.words = next;
      look.words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(look.words[0])));
      break;
    case GuideStep::kTaken:
      look.words = enough ? "Taken" : fmt::format("Taken; {}", next);
      break;
    case GuideStep::kEnough:
      look.words = "That is enough";
      break;
  }
}

CalibrationGuide::CalibrationGuide(const Board& board, Size size) : state_(std::make_unique<State>(board, size)) {}
CalibrationGuide::CalibrationGuide(CalibrationGuide&&) noexcept = default;
CalibrationGuide& CalibrationGuide::operator=(CalibrationGuide&&) noexcept = default;
CalibrationGuide::~CalibrationGuide() = default;

GuideLook CalibrationGuide::see(const Pair& pair) {
  State& s = *state_;
  BoardView view = s.calibrator.look(pair, fmt::format("view {}", s.taken.size() + 1));
  GuideLook out;
  out.left = view.left, out.right = view.right;
  if (!view.why_not.empty()) {
    s.still_since_ns.reset();
    const bool blurred = view.why_not.starts_with("blurred");
    s.advise(out, blurred                                   ? GuideStep::kBlurred
                  : view.left.empty() == view.right.empty() ? GuideStep::kShowBoard
                                                            : GuideStep::kOneCamera);
    return out;
  }
  const BoardPlace place = place_of(view.left, s.board, s.size);
  const BoardPlace in_right = place_of(view.right, s.board, s.size);
  const BoardWishes meets = met_by(place, in_right);
  out.perhaps_swapped = in_right.left + in_right.right > place.left + place.right + 2 * kSwapped;
  out.held = s.held(view, pair.left.t_ns);
  if (!s.adds(view, place, meets)) {
    s.advise(out, GuideStep::kMove);
  } else if (out.held < 1) {
    s.advise(out, GuideStep::kHoldStill);
  } else {
    s.take(std::move(view), place, meets, pair);
    s.advise(out, GuideStep::kTaken);
  }
  return out;
}

const Board& CalibrationGuide::board() const { return state_->board; }
void CalibrationGuide::set_square_m(double square_m) {
  state_->board.square_m = square_m;
  state_->calibrator.set_square_m(square_m);
}
bool CalibrationGuide::enough() const { return !state_->next_wish() && state_->taken.size() >= kGoodViews; }
int CalibrationGuide::views() const { return static_cast<int>(state_->taken.size()); }
const BoardWishes& CalibrationGuide::met() const { return state_->met; }
Coverage CalibrationGuide::covered(int camera) const { return state_->calibrator.covered(camera); }
const Pair& CalibrationGuide::shown() const { return state_->shown; }
Result<Calibration> CalibrationGuide::solve() const { return state_->calibrator.solve(); }

std::optional<Board> other_board(const Pair& pair, const Board& named) {
  return recognise_board(gray_of(pair.left), gray_of(pair.right), named);
}

}  // namespace duo
