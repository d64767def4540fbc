// The panel with depth, and the one with the rectified pair.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "panels.h"

namespace duo::app::view {
namespace {

bool same_colors(const ViewChoices& a, const ViewChoices& b) {
  return a.colors == b.colors && a.own_range == b.own_range && a.near_m == b.near_m && a.far_m == b.far_m;
}

}  // namespace

/// Where frame or choices are new.
Result<void> Panels::paint_depth() {
  quality_.set_distance(choices_.wall_m);
  const bool chosen = !same_colors(choices_, painted_choices_);
  if (!shown_ || (!depth_stale_ && !chosen)) return {};
  if (depth_strip_.size().empty() || chosen) DUO_TRY(depth_strip_.set(depth_strip(choices_.colors)));
  shown_range_ = range_;
  if (choices_.own_range)
    shown_range_ = {header_.rectified.disparity_px(choices_.far_m), header_.rectified.disparity_px(choices_.near_m)};
  color_disparity(shown_->frame->disparity.d_q4, shown_range_, painted_, choices_.colors);
  draw_unmatched(*shown_->frame, painted_);
  DUO_TRY(depth_.set(painted_));
  painted_choices_ = choices_;
  depth_stale_ = false;
  return {};
}

void Panels::draw_depth(const Cell& cell) {
  if (!shown_) return;
  const Fit fit = picture(cell, depth_);
  put_depth_legend(cell);
  drag_region(fit);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(fit.from, fit.to) && !drag_from_) put_depth_at_pointer(fit);
}

void Panels::put_depth_at_pointer(const Fit& fit) const {
  const ImVec2 mouse = ImGui::GetMousePos();
  const auto& d_q4 = shown_->frame->disparity.d_q4;
  const int x = std::clamp(static_cast<int>((mouse.x - fit.from.x) / fit.scale), 0, d_q4.width() - 1);
  const int y = std::clamp(static_cast<int>((mouse.y - fit.from.y) / fit.scale), 0, d_q4.height() - 1);
  const std::uint16_t d = d_q4.at(y, x);
  const duo::Window& matched = shown_->frame->matched;
  std::string text = matched.empty() || matched.contains(y, x) ? "no depth" : "not matched";
  if (d != Disparity::kNone && d != 0) {
    const Vec3 p_m = header_.rectified.triangulate({static_cast<double>(x), static_cast<double>(y)}, d / 16.0);
    text = fmt::format("{:.2f}{}   x {:+.2f}  y {:+.2f}", p_m.z, header_.metric ? " m" : "", p_m.x, p_m.y);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircle(mouse, 5 * scale_, kText, 0, 1.5f * scale_);
  const float width = ImGui::CalcTextSize(text.c_str()).x + 20 * scale_;
  text_on_picture(list, {mouse.x + width > fit.to.x ? mouse.x - width : mouse.x + 14 * scale_, mouse.y + 10 * scale_}, kText,
                  text.c_str());
}

/// The colours with round metres below them: what fits first, in the order of importance, stays.
void Panels::put_depth_legend(const Cell& cell) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 to = {cell.caption.x + cell.caption_width, cell.caption.y + 10 * scale_};
  if (shown_range_.empty()) return list.AddText(cell.caption, kFaint, "no depth");
  depth_strip_.draw(list, cell.caption, to);
  std::vector<std::pair<float, float>> taken;
  for (const double z_m :
       {1.0, 2.0, 0.5, 5.0, 3.0, 1.5, 10.0, 0.7, 4.0, 2.5, 0.3, 0.4, 0.6, 0.8, 1.2, 7.0, 0.9, 6.0, 3.5, 1.4, 1.8, 20.0}) {
    const double share =
        (header_.rectified.disparity_px(z_m) - shown_range_.far_px) / (shown_range_.near_px - shown_range_.far_px);
    if (share < 0 || share > 1) continue;
    const std::string text = fmt::format("{:g}{}", z_m, header_.metric ? " m" : "");
    const float x = cell.caption.x + static_cast<float>(share) * cell.caption_width,
                half = ImGui::CalcTextSize(text.c_str()).x / 2;
    const float left = x - half - 6 * scale_, right = x + half + 6 * scale_;
    if (left < cell.caption.x - 6 * scale_ || right > to.x + 6 * scale_ ||
        std::any_of(taken.begin(), taken.end(), [&](const auto& other) { return left < other.second && other.first < right; }))
      continue;
    taken.emplace_back(left, right);
    list.AddLine({x, to.y}, {x, to.y + 3 * scale_}, kFaint);
    list.AddText({x - half, to.y + 3 * scale_}, kText, text.c_str());
  }
}

/// A rectangle that is dragged is measured as a flat wall; a click takes it away.
void Panels::drag_region(const Fit& fit) {
  const auto pixel_at = [&](ImVec2 mouse) {
    return ImVec2((mouse.x - fit.from.x) / fit.scale, (mouse.y - fit.from.y) / fit.scale);
  };
  const auto between = [](ImVec2 a, ImVec2 b) {
    const auto x0 = static_cast<int>(std::min(a.x, b.x)), y0 = static_cast<int>(std::min(a.y, b.y));
    return duo::Window{x0, y0, static_cast<int>(std::abs(a.x - b.x)), static_cast<int>(std::abs(a.y - b.y))};
  };
  const ImVec2 mouse = ImGui::GetMousePos();
  if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(fit.from, fit.to) && ImGui::IsMouseClicked(ImGuiMouseButton_Left))
    drag_from_ = pixel_at(mouse);
  duo::Window region = quality_.region();
  if (drag_from_) {
    constexpr int kSmallest_px = 8;
    region = between(*drag_from_, pixel_at(mouse)).within(header_.rectified.size);
    if (region.width < kSmallest_px || region.height < kSmallest_px) region = {};
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
      drag_from_.reset();
      quality_.choose(header_.rectified, region);
      quality_.add(*shown_->frame);
    }
  }
  if (region.empty()) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto place = [&](int x, int y) {
    return ImVec2(fit.from.x + static_cast<float>(x) * fit.scale, fit.from.y + static_cast<float>(y) * fit.scale);
  };
  list.AddRect(place(region.x, region.y), place(region.x_end(), region.y_end()), kText, 0, 0, 2 * scale_);
  if (drag_from_) return;
  list.PushClipRect(fit.from, fit.to, true);
  const float line = ImGui::GetTextLineHeight() + 4 * scale_;
  float y = fit.to.y - line * static_cast<float>(quality_.lines().size()) - 4 * scale_;
  for (const std::string& text : quality_.lines()) {
    text_on_picture(list, {fit.from.x + 8 * scale_, y}, kText, text.c_str());
    y += line;
  }
  list.PopClipRect();
}

/// Both rectified pictures, gray, with lines that every point should share.
Result<void> Panels::draw_rectified_pair(const Cell& cell) {
  if (!shown_) return {};
  const Frame& frame = *shown_->frame;
  if (frame.left.empty() || frame.right.empty()) {
    ImGui::GetWindowDrawList()->AddText(cell.from, kFaint, "the engine keeps them on its device");
    return {};
  }
  if (pair_stale_) DUO_TRY(pair_.set(draw_rectified(frame)));
  pair_stale_ = false;
  const Fit fit = picture(cell, pair_);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr int kLines = 12;
  for (int i = 1; i < kLines; ++i) {
    const float y = fit.from.y + (fit.to.y - fit.from.y) * static_cast<float>(i) / kLines;
    list.AddLine({fit.from.x, y}, {fit.to.x, y}, IM_COL32(250, 190, 60, 130), scale_);
  }
  const ImVec2 mouse = ImGui::GetMousePos();
  if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(fit.from, fit.to))
    list.AddLine({fit.from.x, mouse.y}, {fit.to.x, mouse.y}, kAccent, 1.5f * scale_);
  return {};
}

}  // namespace duo::app::view
