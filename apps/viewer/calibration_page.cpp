#include "calibration_page.h"

#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "duoptic/board.h"
#include "duoptic/interrupt.h"
#include "style.h"

namespace duo::app::view {
namespace {

constexpr ImU32 kCovered = IM_COL32(60, 230, 80, 46), kRow = IM_COL32(250, 190, 60, 220);

/// "rig.json", or the first of "rig_2.json" and so on that no file has.
std::string free_rig_name() {
  std::error_code ignored;
  std::string name = "rig.json";
  for (int i = 2; std::filesystem::exists(name, ignored); ++i) name = fmt::format("rig_{}.json", i);
  return name;
}

template <std::size_t N>
void set_text(std::array<char, N>& field, const std::string& text) {
  std::snprintf(field.data(), N, "%s", text.c_str());
}

}  // namespace

CalibrationPage::CalibrationPage(Window& window, std::unique_ptr<CalibrationSession> session, const Board& board, bool can_swap)
    : window_(window), session_(std::move(session)), square_mm_(1000 * board.square_m), can_swap_(can_swap) {
  set_text(board_, board.name());
  set_text(file_, free_rig_name());
}

Result<CalibrationEnd> CalibrationPage::run(Window& window, CalibrationSessionSetup setup, std::unique_ptr<PairSource> pairs,
                                            bool can_swap) {
  DUO_TRY_ASSIGN(const Paper paper, parse_paper("a4"));
  DUO_TRY_ASSIGN(const Board board, largest_board("chessboard:9x6", paper));
  DUO_TRY_ASSIGN(auto session, CalibrationSession::start(std::move(setup), std::move(pairs), board));
  CalibrationPage page(window, std::move(session), board, can_swap);
  DUO_TRY(page.show());
  return page.end_;
}

Result<void> CalibrationPage::show() {
  while (!window_.closing() && !Interrupt::asked() && !left_) {
    Window::wait(ImGui::IsAnyMouseDown() ? 0.01 : 0.1);
    if (!window_.begin()) continue;
    status_ = session_->status();
    DUO_TRY(draw());
    window_.end();
    if (const std::string said = window_.write_screenshot(); !said.empty()) note_ = said;
  }
  return {};
}

Result<void> CalibrationPage::draw() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float scale = window_.scale(), margin = 8 * scale, half = (size.x - 3 * margin) / 2, around = 56 * scale;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("calibration", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
  float high = 0.75f * half;
  if (status_.pair)
    high =
        half * static_cast<float>(status_.pair->left.pixels.height()) / static_cast<float>(status_.pair->left.pixels.width());
  const float bottom = margin + std::min(high + around, size.y - margin - 210 * scale);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const float x = margin + static_cast<float>(i) * (half + margin);
    DUO_TRY(draw_picture(i, {x, margin}, {x + half, bottom}));
  }
  drawn_ = status_.pair;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * scale, 10 * scale});
  const float beside = std::min(330 * scale, 0.5f * size.x);
  ImGui::SetCursorScreenPos({margin, bottom + margin});
  ImGui::BeginChild("words", {size.x - beside - 3 * margin, size.y - bottom - 2 * margin}, false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding);
  put_words();
  put_result();
  ImGui::EndChild();
  ImGui::SetCursorScreenPos({size.x - beside - margin, bottom + margin});
  ImGui::BeginChild("ways", {beside, size.y - bottom - 2 * margin}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
  put_ways_on();
  put_board();
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::End();
  take_keys();
  put_title();
  return {};
}

/// A panel with one camera's picture; a click on it chooses a row.
Result<void> CalibrationPage::draw_picture(std::size_t side, ImVec2 from, ImVec2 to) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float scale = window_.scale(), margin = 8 * scale;
  list.AddRectFilled(from, to, kPanel, 6 * scale);
  ImGui::PushFont(title_font());
  list.AddText({from.x + margin, from.y + 5 * scale}, kText, side == 0 ? "Left camera" : "Right camera");
  ImGui::PopFont();
  if (!status_.pair) {
    list.AddText({from.x + margin, from.y + 36 * scale}, kFaint, "waiting for the first pictures ...");
    return {};
  }
  const Image<Rgb8>& pixels = (side == 0 ? status_.pair->left : status_.pair->right).pixels;
  if (drawn_ != status_.pair) DUO_TRY(textures_[side].set(pixels));
  const float room_x = to.x - from.x - 2 * margin, room_y = to.y - from.y - 54 * scale;
  const float per_px =
      std::max(0.01f, std::min(room_x / static_cast<float>(pixels.width()), room_y / static_cast<float>(pixels.height())));
  const float width = per_px * static_cast<float>(pixels.width()), height = per_px * static_cast<float>(pixels.height());
  const ImVec2 corner = {from.x + (to.x - from.x - width) / 2, from.y + 26 * scale + (room_y - height) / 2};
  const Fit fit = {corner, {corner.x + width, corner.y + height}};
  textures_[side].draw(list, fit.from, fit.to);
  draw_board(side, fit);
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && ImGui::IsMouseHoveringRect(fit.from, fit.to))
    row_ = (ImGui::GetMousePos().y - fit.from.y) / height;
  if (row_)
    list.AddLine({fit.from.x, fit.from.y + *row_ * height}, {fit.to.x, fit.from.y + *row_ * height}, kRow, 1.5f * scale);
  const PictureFigures& figures = status_.figures[side];
  const std::string text = fmt::format("focus {:.0f} (best {:.0f})   brightness {:.0f} %   white {:.0f} %", figures.focus,
                                       status_.best_focus[side], figures.brightness_percent, figures.white_percent);
  const bool doubtful = figures.white_percent > 5 || figures.brightness_percent < 12;
  list.PushClipRect(from, to, true);
  list.AddText({from.x + margin, to.y - 22 * scale}, doubtful ? kWarn : kFaint, text.c_str());
  list.PopClipRect();
  return {};
}

/// Cells that corners have covered, where the board is wanted, and its corners now.
void CalibrationPage::draw_board(std::size_t side, const Fit& fit) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float scale = window_.scale(), width = fit.to.x - fit.from.x, height = fit.to.y - fit.from.y;
  const auto place = [&](double x, double y) {
    return ImVec2(fit.from.x + static_cast<float>(x) * width, fit.from.y + static_cast<float>(y) * height);
  };
  list.PushClipRect(fit.from, fit.to, true);
  constexpr int kAcross = kCoverageSize.width, kDown = kCoverageSize.height;
  for (int y = 0; y < kDown; ++y)
    for (int x = 0; x < kAcross; ++x)
      if (status_.covered[side][static_cast<std::size_t>(y * kAcross + x)])
        list.AddRectFilled(place(static_cast<double>(x) / kAcross, static_cast<double>(y) / kDown),
                           place((x + 1.0) / kAcross, (y + 1.0) / kDown), kCovered);
  const bool looking = status_.state == SessionState::kLooking;
  const auto ninth = looking && status_.look.wish ? ninth_of(*status_.look.wish) : std::nullopt;
  if (ninth) {
    const ImVec2 a = place((*ninth)[0] / 3.0, (*ninth)[1] / 3.0), b = place(((*ninth)[0] + 1) / 3.0, ((*ninth)[1] + 1) / 3.0);
    const ImVec2 corners[] = {a, {b.x, a.y}, b, {a.x, b.y}};
    for (std::size_t i = 0; i < 4; ++i) dashed_line(list, corners[i], corners[(i + 1) % 4], kAccent, 2 * scale, 6 * scale);
  }
  const Size pixels = status_.pair->left.pixels.size();
  const ImU32 color = status_.look.step == GuideStep::kTaken ? kBox : kAccent;
  for (const BoardCorner& corner : side == 0 ? status_.look.left : status_.look.right)
    list.AddCircle(place((corner.x_px + 0.5) / pixels.width, (corner.y_px + 0.5) / pixels.height), 3.5f * scale, color, 0,
                   1.5f * scale);
  list.PopClipRect();
}

/// What to do now, in large letters, and how far it is.
void CalibrationPage::put_words() {
  const GuideLook& look = status_.look;
  const bool solved = status_.state == SessionState::kSolved, ended = status_.state == SessionState::kEnded;
  const std::string words = solved                                    ? "The rig is found"
                            : status_.state == SessionState::kSolving ? "Calibrating ..."
                            : ended                                   ? "No more pictures"
                            : status_.pair                            ? look.words
                                                                      : "Waiting for pictures";
  ImGui::SetWindowFontScale(ImGui::GetIO().DisplaySize.x > 900 * window_.scale() ? 1.7f : 1.3f);
  put_text(solved || look.step == GuideStep::kTaken ? kBox : kAccent, words, title_font());
  ImGui::SetWindowFontScale(1);
  if (status_.silent) put_text(kBad, "no pictures come: is a camera unplugged?");
  if (!status_.problem.empty()) put_text(kBad, status_.problem);
  if (look.perhaps_swapped && !solved)
    put_text(kWarn, "the board lies farther right in the right picture: are left and right swapped?");
  if (!problem_.empty()) put_text(kBad, problem_);
  if (solved) return;
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, kBox);
  ImGui::ProgressBar(look.step == GuideStep::kHoldStill ? static_cast<float>(look.held) : 0.0f, {-1, 4 * window_.scale()}, "");
  ImGui::PopStyleColor();
  const auto met = std::count(status_.met.begin(), status_.met.end(), true);
  const auto share = [](const Coverage& cells) {
    return 100 * std::count(cells.begin(), cells.end(), true) / static_cast<std::ptrdiff_t>(cells.size());
  };
  std::string far = fmt::format("{} of {} wishes met, {} view{} taken; covered: {} % of the left picture, {} % of the right",
                                met, kBoardWishes, status_.views, status_.views == 1 ? "" : "s", share(status_.covered[0]),
                                share(status_.covered[1]));
  if (status_.count > 0) far += fmt::format("; {} % of the file", 100 * status_.looked / status_.count);
  put_text(kFaint, far);
  put_wishes();
  if (status_.views == 0 && !ended)
    put_text(kFaint,
             "Print a board with duoptic board -o board.pdf and tape it flat. Turn the lenses until focus is largest, then fix "
             "them. A click on a picture draws the same row in both: the cameras should look the same way.");
}

/// All of them by name, as many in a row as fit; green: met.
void CalibrationPage::put_wishes() const {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x, gap = 14 * window_.scale();
  for (std::size_t i = 0; i < kBoardWishes; ++i) {
    const char* const name = name_of(static_cast<BoardWish>(i));
    if (i > 0 && ImGui::GetItemRectMax().x + gap + ImGui::CalcTextSize(name).x < right) ImGui::SameLine(0, gap);
    ImGui::PushStyleColor(ImGuiCol_Text, status_.met[i] ? kBox : kFaint);
    ImGui::TextUnformatted(name);
    ImGui::PopStyleColor();
  }
}

/// The figures of the rig in mm.
void CalibrationPage::put_result() {
  if (!status_.found) return;
  const Rig& rig = status_.found->rig;
  const RigUncertainty& u = *rig.uncertainty;
  put_fact("baseline", fmt::format("{:.2f} \u00b1 {:.2f} mm", 1000 * rig.baseline_m(), 1000 * u.baseline_m));
  put_fact("depth", fmt::format("\u00b1 {:.1f} mm at 1 m, {:.1f} mm at 1.5 m, {:.1f} mm at 2 m", 1000 * u.depth_m[0],
                                1000 * u.depth_m[1], 1000 * u.depth_m[2]));
  put_fact("left-out views",
           fmt::format("boards {:.2f} m away measured to {:.1f} mm, rows {:.2f} px off", status_.found->held_out_z_m,
                       1000 * status_.found->held_out_shape_m, rig.errors.held_out_row_px));
  put_fact("corners", fmt::format("{:.2f} px off; focal lengths {:.1f} and {:.1f} px", rig.reprojection_rms_px,
                                  (rig.left.fx_px + rig.left.fy_px) / 2, (rig.right.fx_px + rig.right.fy_px) / 2));
  for (const std::string& warning : status_.found->warnings) put_text(kWarn, warning);
}

void CalibrationPage::put_ways_on() {
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (status_.state == SessionState::kSolved) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("save as");
    ImGui::SameLine(70 * window_.scale());
    ImGui::SetNextItemWidth(-1);
    ImGui::InputText("##file", file_.data(), file_.size());
    ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(36, 92, 150, 255));
    if (ImGui::Button("Save and track (Enter)", {-1, 0})) save();
    ImGui::PopStyleColor();
    if (session_->live()) {
      if (ImGui::Button("More views", {half, 0})) session_->go_on();
      ImGui::SameLine();
    }
  } else if (status_.views >= CalibrationGuide::kFewestViews && status_.state == SessionState::kLooking) {
    if (ImGui::Button("Calibrate now (Enter)", {-1, 0})) session_->solve();
  }
  if (can_swap_ && ImGui::Button("Swap left and right", {-1, 0})) left_ = end_.swapped = true;
  if (ImGui::Button("Start again", {half, 0})) session_->choose(session_->board());
  ImGui::SameLine();
  if (ImGui::Button("Leave", {half, 0})) left_ = true;
}

/// Which board, and how large its squares are.
void CalibrationPage::put_board() {
  const auto choose = [this] {
    const auto board = parse_board(board_.data(), square_mm_ / 1000);
    problem_ = board ? "" : board.error().what;
    if (board) session_->choose(*board);
  };
  const Board now = session_->board();
  if (!ImGui::IsAnyItemActive()) set_text(board_, now.name());  // what was recognised
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("board");
  ImGui::SameLine(70 * window_.scale());
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 96 * window_.scale());
  ImGui::InputText("##board", board_.data(), board_.size());
  if (ImGui::IsItemDeactivatedAfterEdit()) choose();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("chessboard:9x6 (inner corners) or charuco:9x6 (squares)");
  ImGui::SameLine();
  if (ImGui::Button("Recognise", {-1, 0})) session_->recognise();
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("square");
  ImGui::SameLine(70 * window_.scale());
  ImGui::SetNextItemWidth(96 * window_.scale());
  ImGui::InputDouble("##square", &square_mm_, 0, 0, "%.2f mm");
  if (ImGui::IsItemDeactivatedAfterEdit()) {
    const auto board = parse_board(now.name(), square_mm_ / 1000);
    problem_ = board ? "" : board.error().what;
    if (board) session_->set_square_m(board->square_m);
  }
  ImGui::SameLine();
  ImGui::TextDisabled("as measured");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("All distances grow and shrink with it.");
  if (!note_.empty()) put_text(kFaint, note_);
}

void CalibrationPage::take_keys() {
  for (const int key : window_.keys()) {
    if (key == GLFW_KEY_F12) window_.want_screenshot();
    if (key == GLFW_KEY_Q) left_ = true;
    if (key != GLFW_KEY_ENTER && key != GLFW_KEY_KP_ENTER) continue;
    if (status_.state == SessionState::kSolved)
      save();
    else if (status_.views >= CalibrationGuide::kFewestViews && status_.state == SessionState::kLooking)
      session_->solve();
  }
}

void CalibrationPage::save() {
  const Result<void> saved = session_->save(file_.data());
  problem_ = saved ? "" : saved.error().what;
  if (!saved) return;
  end_.rig = file_.data();
  left_ = true;
}

void CalibrationPage::put_title() const {
  const char* const doing = status_.state == SessionState::kSolved    ? "the rig is found"
                            : status_.state == SessionState::kSolving ? "calibrating"
                            : status_.state == SessionState::kEnded   ? "no more pictures"
                            : status_.pair                            ? status_.look.words.c_str()
                                                                      : "waiting for pictures";
  window_.set_title(fmt::format("duoptic view: {}", doing));
}

}  // namespace duo::app::view
