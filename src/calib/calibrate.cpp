#include "duoptic/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calib/doubt_calibration.h"
#include "calib/find_board.h"
#include "calib/judge_bundle.h"
#include "calib/recognise_board.h"
#include "calib/start_bundle.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr std::size_t kMinViews = 6, kMaxViews = 40, kMinCorners = 8;
constexpr double kMinTilt_rad = 10 * std::numbers::pi / 180;
constexpr double kMaxSpread = 0.12, kMaxSpread_px = 3;  // of a blurred edge: share of a square, and px
constexpr double kRefusedRms_px = 1, kRefusedRow_px = 0.75;
constexpr double kPoorView_px = 0.3, kPoorView = 2.5;  // rms of a view's corners; and of the median view's
constexpr std::size_t kKeptPairs = 3;

Error refused(const std::string& why) { return {ErrorCode::kBadInput, "cannot calibrate: " + why}; }

/// Angle between the board's normals that differ most.
double tilt_rad(const Bundle& bundle) {
  double most = 0;
  const Vec3 z{0, 0, 1};
  for (const BoardPose& a : bundle.poses)
    for (const BoardPose& b : bundle.poses)
      most =
          std::max(most, std::acos(std::clamp(dot(a.left_from_board.rotation * z, b.left_from_board.rotation * z), -1.0, 1.0)));
  return most;
}

/// A chessboard's corners look the same after half a turn: numbers the right ones so that the board runs the same way in both.
void number_alike(const Board& board, const std::vector<BoardCorner>& left, std::vector<BoardCorner>& right) {
  if (board.kind != Board::Kind::kChessboard || left.empty() || right.empty()) return;
  const auto along = [](const std::vector<BoardCorner>& c) {
    return cv::Point2d(c.back().x_px - c.front().x_px, c.back().y_px - c.front().y_px);
  };
  if (along(left).dot(along(right)) >= 0) return;
  std::reverse(right.begin(), right.end());
  for (BoardCorner& corner : right) corner.id = board.corners() - 1 - corner.id;
}

/// The same corners had the picture not been mirrored.
std::vector<BoardCorner> mirrored(const std::vector<BoardCorner>& corners, const Board& board, Size size) {
  std::vector<BoardCorner> out = corners;
  const int columns = board.inner_columns();
  for (BoardCorner& c : out) c.x_px = size.width - 1 - c.x_px, c.id = c.id / columns * columns + (columns - 1 - c.id % columns);
  std::sort(out.begin(), out.end(), [](const BoardCorner& a, const BoardCorner& b) { return a.id < b.id; });
  return out;
}

std::string corner_words(const Board& board) {
  return board.kind == Board::Kind::kChessboard
             ? fmt::format("chessboard of {}x{} inner corners", board.inner_columns(), board.inner_rows())
             : fmt::format("ChArUco board of {}x{} squares with {}x{} markers", board.columns, board.rows, board.marker_bits,
                           board.marker_bits);
}

/// The same pose of the board again, as a video of a board held still gives them. Their corners err alike, too: counted twice
/// they would make the result look surer than it is.
bool alike(const BoardView& a, const BoardView& b, Size size) {
  constexpr double kAlike = 0.01;  // of the picture's width
  double sum_px = 0;
  int count = 0;
  for (const BoardCorner& c : a.left)
    for (const BoardCorner& d : b.left)
      if (c.id == d.id) sum_px += std::hypot(c.x_px - d.x_px, c.y_px - d.y_px), ++count;
  return count > 0 && sum_px / count < kAlike * size.width;
}

/// Of views that are alike, the sharpest.
std::vector<const BoardView*> apart(std::vector<const BoardView*> views, Size size) {
  std::stable_sort(views.begin(), views.end(),
                   [](const BoardView* a, const BoardView* b) { return a->sharp_px < b->sharp_px; });
  std::vector<const BoardView*> out;
  for (const BoardView* view : views)
    if (std::none_of(out.begin(), out.end(), [&](const BoardView* other) { return alike(*view, *other, size); }))
      out.push_back(view);
  return out;
}

/// Views spread over places, distances and tilts: each time the one farthest from those taken (Gonzalez, 1985).
std::vector<const BoardView*> spread(const std::vector<const BoardView*>& views, Size size) {
  if (views.size() <= kMaxViews) return views;
  const auto where = [&](const BoardView& view) {
    cv::Mat points(static_cast<int>(view.left.size()), 2, CV_64F);
    for (int i = 0; i < points.rows; ++i) {
      points.at<double>(i, 0) = view.left[static_cast<std::size_t>(i)].x_px / size.width;
      points.at<double>(i, 1) = view.left[static_cast<std::size_t>(i)].y_px / size.width;
    }
    cv::Scalar mean_x, mean_y, spread_x, spread_y;
    cv::meanStdDev(points.col(0), mean_x, spread_x);
    cv::meanStdDev(points.col(1), mean_y, spread_y);
    return std::array<double, 4>{mean_x[0], mean_y[0], 2 * spread_x[0], 2 * spread_y[0]};
  };
  std::vector<std::array<double, 4>> places;
  for (const BoardView* view : views) places.push_back(where(*view));
  std::vector<double> distance(views.size(), 1e9);
  std::vector<const BoardView*> taken;
  for (std::size_t next = 0; taken.size() < kMaxViews;
       next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin())) {
    taken.push_back(views[next]);
    for (std::size_t i = 0; i < views.size(); ++i) {
      double d = 0;
      for (std::size_t k = 0; k < 4; ++k) d += std::pow(places[i][k] - places[next][k], 2);
      distance[i] = std::min(distance[i], d);
    }
    distance[next] = -1;
  }
  return taken;
}

}  // namespace

struct Calibrator::State {
  Board board;
  Size size;
  int pairs = 0;
  std::vector<BoardView> views;
  bool any_found = false;
  std::vector<std::pair<cv::Mat, cv::Mat>> first_pairs;  // until a board was found

  BoardView look(const Pair& pair, const std::string& name, BoardSearch search) const;
  Result<std::vector<const BoardView*>> usable() const;
  Error no_board() const;
  Error disagreeing(const std::vector<const BoardView*>& views) const;
  Result<Bundle> fit(std::vector<const BoardView*>& views, std::vector<std::string>& rejected) const;
};

BoardView Calibrator::State::look(const Pair& pair, const std::string& name, BoardSearch search) const {
  BoardView view;
  view.name = name;
  bool blurred = false;
  for (const bool left : {true, false}) {
    const cv::Mat gray = gray_of(left ? pair.left : pair.right);
    FoundBoard found = find_board(gray, board, search);
    if (!found.corners.empty()) {
      const double spread_px = edge_spread_px(gray, board, found);
      view.sharp_px = std::max(view.sharp_px, spread_px);
      blurred = blurred || spread_px > std::max(kMaxSpread_px, kMaxSpread * found.spacing_px);
    }
    (left ? view.left : view.right) = std::move(found.corners);
  }
  number_alike(board, view.left, view.right);
  if (view.left.size() < kMinCorners || view.right.size() < kMinCorners)
    view.why_not = view.left.empty() && view.right.empty() ? "no board found"
                   : view.left.size() < kMinCorners        ? "board not found in the left picture"
                                                           : "board not found in the right picture";
  else if (blurred)
    view.why_not = fmt::format("blurred: edges are {:.1f} px wide", view.sharp_px);
  return view;
}

Error Calibrator::State::no_board() const {
  if (board.kind == Board::Kind::kCharuco)
    for (const auto& [left, right] : first_pairs) {
      cv::Mat flipped;
      cv::flip(left, flipped, 1);
      if (!find_board(flipped, board).corners.empty())
        return refused("the pictures are mirrored; switch off the mirror of the camera program");
    }
  return refused(fmt::format(
      "no {} found in any of {} pairs; it must be whole in both pictures, lit evenly and sharp (and named by --board)",
      corner_words(board), pairs));
}

Result<std::vector<const BoardView*>> Calibrator::State::usable() const {
  std::vector<const BoardView*> out;
  std::size_t blurred = 0, found = 0;
  for (const BoardView& view : views) {
    found += !view.left.empty() || !view.right.empty();
    blurred += view.why_not.starts_with("blurred");
    if (view.why_not.empty()) out.push_back(&view);
  }
  if (found == 0) return no_board();
  if (const auto different = apart(out, size); different.size() >= kMinViews) return spread(different, size);
  if (out.size() >= kMinViews) return out;
  if (blurred > 0 && out.size() + blurred >= kMinViews)
    return refused(fmt::format("{} of {} views are blurred; hold the board still, use more light, check the focus", blurred,
                               views.size()));
  return refused(
      fmt::format("too few views: {} of {} pairs show the board whole and sharp to both cameras, {} are needed and "
                  "15 are good; show it at more places",
                  out.size(), pairs, kMinViews));
}

Error Calibrator::State::disagreeing(const std::vector<const BoardView*>& used) const {
  std::vector<BoardView> flipped;
  for (const BoardView* view : used) {
    flipped.push_back(*view);
    flipped.back().right = mirrored(view->right, board, size);
    number_alike(board, flipped.back().left, flipped.back().right);
  }
  std::vector<const BoardView*> pointers;
  for (const BoardView& view : flipped) pointers.push_back(&view);
  if (const auto start = start_bundle(pointers, board, size); start && start->pose_spread_rad < kMinTilt_rad / 5)
    return refused("one camera's pictures are mirrored; switch off the mirror of its program");
  return refused(
      "left and right pictures do not belong together: the pose between the cameras differs from view to view; give "
      "pictures of the same moments in the same order, with the cameras fixed to each other");
}

Result<Bundle> Calibrator::State::fit(std::vector<const BoardView*>& used, std::vector<std::string>& rejected) const {
  DUO_TRY_ASSIGN(BundleStart start, start_bundle(used, board, size));
  Bundle bundle = std::move(start.bundle);
  if (tilt_rad(bundle) < kMinTilt_rad)
    return refused(
        fmt::format("all {} views show the board in nearly the same pose; tilt it 20 to 40 degrees, left, right, up "
                    "and down, near and far",
                    used.size()));
  if (start.pose_spread_rad > kMinTilt_rad / 3) return disagreeing(used);
  if (bundle.right_from_left.t_m.x > 0)
    return refused("left and right are swapped, or the pictures of both cameras mirrored; give the left camera's first");
  const std::size_t all = used.size();
  for (;;) {
    if (!adjust(used, board, bundle))
      return refused("the views do not determine both cameras; tilt the board and show it all over the picture");
    // Noise alone makes views differ by a tenth. One that fits much worse than most: the board moved between both pictures,
    // or was bent, or misread.
    std::vector<double> rms;
    for (const BoardPose& pose : bundle.poses) rms.push_back(std::max(pose.rms_px[0], pose.rms_px[1]));
    const auto worst = std::max_element(rms.begin(), rms.end()) - rms.begin();
    if (rms[static_cast<std::size_t>(worst)] < std::max(kPoorView_px, kPoorView * median(std::vector(rms)))) break;
    rejected.push_back(used[static_cast<std::size_t>(worst)]->name);
    used.erase(used.begin() + worst), bundle.poses.erase(bundle.poses.begin() + worst);
    if (used.size() < kMinViews || 3 * rejected.size() > all)
      return refused(
          fmt::format("{} of {} views do not fit the others; keep board flat and still, and both cameras fixed to each "
                      "other",
                      rejected.size(), all));
  }
  // The third radial coefficient only where it stands out; else it only adds noise.
  Bundle free = bundle;
  free.with_k3 = {true, true};
  if (adjust(used, board, free)) {
    bool either = false;
    for (const int side : {0, 1}) {
      const int k3 = 9 * side + 8;
      const double sigma = std::sqrt(std::max(free.covariance(k3, k3), free.jackknife(k3, k3)));
      const double value = (side == 0 ? free.left : free.right).distortion[4];
      either |= bundle.with_k3[static_cast<std::size_t>(side)] = std::abs(value) > 3 * sigma;
    }
    if (either && !adjust(used, board, bundle)) return refused("the lenses do not fit any model; check the pictures");
  }
  return bundle;
}

Calibrator::Calibrator(const Board& board, Size size) : state_(std::make_unique<State>()) {
  state_->board = board;
  state_->size = size;
}
Calibrator::Calibrator(Calibrator&&) noexcept = default;
Calibrator::~Calibrator() = default;

Result<const BoardView*> Calibrator::add(const Pair& pair, const std::string& name) {
  for (const Picture* picture : {&pair.left, &pair.right})
    if (const Size size = picture->pixels.size(); size != state_->size)
      return refused(fmt::format("the {} picture of {} is {}x{}, the first one {}x{}; all must have one size",
                                 picture == &pair.left ? "left" : "right", name, size.width, size.height, state_->size.width,
                                 state_->size.height));
  // Another board is told with the first pair that shows it: the search for what is not there takes seconds a picture.
  if (!state_->any_found && state_->first_pairs.size() < kKeptPairs) {
    const auto& [left, right] = state_->first_pairs.emplace_back(gray_of(pair.left), gray_of(pair.right));
    if (const auto seen = recognise_board(left, right, state_->board))
      return refused(fmt::format("a {} was looked for, but {} shows a {}; give --board {}", corner_words(state_->board), name,
                                 corner_words(*seen), seen->name()));
  }
  return keep(state_->look(pair, name, BoardSearch::kThorough));
}

BoardView Calibrator::look(const Pair& pair, const std::string& name) const {
  return state_->look(pair, name, BoardSearch::kQuick);
}

const BoardView* Calibrator::keep(BoardView view) {
  ++state_->pairs;
  state_->any_found = state_->any_found || !view.left.empty() || !view.right.empty();
  return &state_->views.emplace_back(std::move(view));
}

void Calibrator::set_square_m(double square_m) { state_->board.square_m = square_m; }

int Calibrator::pairs() const { return state_->pairs; }
const std::vector<BoardView>& Calibrator::views() const { return state_->views; }

Coverage Calibrator::covered(int camera) const {
  Coverage cells{};
  for (const BoardView& view : state_->views)
    for (const BoardCorner& c : camera == 0 ? view.left : view.right) {
      const int x = std::clamp(static_cast<int>(c.x_px * kCoverageSize.width / state_->size.width), 0, kCoverageSize.width - 1);
      const int y =
          std::clamp(static_cast<int>(c.y_px * kCoverageSize.height / state_->size.height), 0, kCoverageSize.height - 1);
      cells[static_cast<std::size_t>(y * kCoverageSize.width + x)] = true;
    }
  return cells;
}

double Calibrator::coverage(int camera) const {
  const Coverage cells = covered(camera);
  return static_cast<double>(std::count(cells.begin(), cells.end(), true)) / static_cast<double>(cells.size());
}

Result<Calibration> Calibrator::solve() const {
  DUO_TRY_ASSIGN(std::vector<const BoardView*> used, state_->usable());
  std::vector<std::string> rejected;
  DUO_TRY_ASSIGN(const Bundle bundle, state_->fit(used, rejected));
  Calibration out;
  out.rig = rig_of(used, state_->board, bundle);
  Rig& rig = out.rig;
  const RigUncertainty& sigma = *rig.uncertainty;
  DUO_TRY(check_rig(rig, "just calibrated"));
  if (rig.reprojection_rms_px > kRefusedRms_px || rig.errors.row_px > kRefusedRow_px)
    return refused(fmt::format(
        "the views do not fit one rig: {:.2f} px reprojection (left {:.2f}, right {:.2f}) and {:.2f} px row "
        "error, {:.1f} and {:.2f} are useless; keep the board flat, board and cameras still, focus fixed",
        rig.reprojection_rms_px, rig.errors.left_px, rig.errors.right_px, rig.errors.row_px, kRefusedRms_px, kRefusedRow_px));
  if (sigma.left_focal_px > 0.03 * rig.left.fx_px || sigma.right_focal_px > 0.03 * rig.right.fx_px)
    return refused(
        fmt::format("the focal lengths stay uncertain ({:.0f} and {:.0f} px of {:.0f}); tilt the board more, near and far",
                    sigma.left_focal_px, sigma.right_focal_px, rig.left.fx_px));
  const HeldOut held_out = judge_held_out(used, state_->board, bundle);
  rig.errors.held_out_px = held_out.reprojection_px, rig.errors.held_out_row_px = held_out.row_px;
  if (held_out.row_px > kRefusedRow_px)
    return refused(
        fmt::format("rows differ by {:.2f} px on views left out of the calibration, {:.2f} is useless; take more views, "
                    "spread wider",
                    held_out.row_px, kRefusedRow_px));
  out.held_out_shape_m = held_out.shape_m, out.held_out_z_m = held_out.z_m;
  out.views = state_->views;
  for (BoardView& view : out.views) {
    const auto at = std::find_if(used.begin(), used.end(), [&](const BoardView* u) { return u->name == view.name; });
    if (at == used.end()) {
      if (!view.why_not.empty()) continue;
      view.rejected = std::count(rejected.begin(), rejected.end(), view.name) > 0;
      view.why_not = view.rejected ? "does not fit the others" : "much like another";
      continue;
    }
    view.used = true;
    const BoardPose& pose = bundle.poses[static_cast<std::size_t>(at - used.begin())];
    for (const int side : {0, 1})
      for (BoardCorner& c : side == 0 ? view.left : view.right) {
        const Eigen::Vector2d p = predict(bundle, side, pose, state_->board.corner_m(c.id));
        c.dx_px = c.x_px - p.x(), c.dy_px = c.y_px - p.y();
      }
  }
  out.warnings = doubts_of(out);
  return out;
}

}  // namespace duo
