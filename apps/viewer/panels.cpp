#include "panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace duo::app::view {
namespace {

constexpr float kTitle = 28, kCaption = 34, kMargin = 8;  // heights above and below a picture, and around it

ImVec2 inset(ImVec2 p, float d) { return {p.x + d, p.y + d}; }

}  // namespace

Panels::Panels(const TrackHeader& header, float scale) : header_(header), scale_(scale) {}

Result<void> Panels::show(std::shared_ptr<const Shown> shown) {
  if (shown == shown_) return paint_depth();
  if (shows_ == 0) DUO_TRY(hue_strip_.set(hue_strip()));
  const Frame& frame = *shown->frame;
  const auto& d_q4 = frame.disparity.d_q4;
  constexpr int kEvery = 15;  // colours mean the same from frame to frame: the range follows slowly
  constexpr double kFollow = 0.3, kNearer = 1.25;
  if (shows_++ % kEvery == 0)
    if (const DisparityRange now = roomy_range(d_q4, kNearer); !now.empty()) {
      const double follow = range_.empty() ? 1 : kFollow;
      range_ = {range_.far_px + follow * (now.far_px - range_.far_px),
                range_.near_px + follow * (now.near_px - range_.near_px)};
    }
  if (orbit_.middle_m <= 0 || shows_ == 1) orbit_.middle_m = std::max(0.3, foreground_m(d_q4, header_.rectified));
  DUO_TRY(camera_.set(shown->left->pixels));
  if (painted_.size() != d_q4.size()) painted_ = Image<Rgb8>(d_q4.size());
  draw_regions(frame, header_.rectified, shown->people, painted_);
  DUO_TRY(region_.set(painted_));
  draw_hue(frame.color, painted_);
  DUO_TRY(hue_.set(painted_));
  quality_.add(frame);
  shown_ = std::move(shown);
  cloud_stale_ = depth_stale_ = pair_stale_ = true;
  return paint_depth();
}

/// Two in a row above, three below; one that is enlarged has all the room.
std::array<Panels::Box, Panels::kPanels> Panels::boxes(ImVec2 from, ImVec2 to) const {
  std::array<Box, kPanels> out;
  if (enlarged_) {
    out.fill({from, from});
    out[static_cast<std::size_t>(*enlarged_)] = {from, to};
    return out;
  }
  const float gap = 8 * scale_, half = (to.x - from.x - gap) / 2, third = (to.x - from.x - 2 * gap) / 3;
  // The upper row is as high as its pictures need, but leaves something to the lower one.
  const float high =
      (half - 2 * kMargin * scale_) * static_cast<float>(header_.size.height) / static_cast<float>(header_.size.width);
  const float middle_y = from.y + std::min(high + (kTitle + kCaption) * scale_, 0.62f * (to.y - from.y));
  for (std::size_t i = 0; i < 2; ++i) {
    const float x = from.x + static_cast<float>(i) * (half + gap);
    out[i] = {{x, from.y}, {x + half, middle_y}};
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const float x = from.x + static_cast<float>(i) * (third + gap);
    out[2 + i] = {{x, middle_y + gap}, {x + third, to.y}};
  }
  return out;
}

/// It enlarges a panel, or shows all again; not where clicks on the camera's picture are asked for.
void Panels::take_double_click(const std::array<Box, kPanels>& boxes, const Clicks& clicks) {
  if (!ImGui::IsWindowHovered() || !ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) return;
  for (int i = 0; i < kPanels; ++i) {
    const Box& box = boxes[static_cast<std::size_t>(i)];
    if (box.from.x == box.to.x || !ImGui::IsMouseHoveringRect(box.from, box.to) || (i == kCamera && clicks.wanted())) continue;
    enlarged_ = enlarged_ ? std::nullopt : std::optional(i);
    return;
  }
}

Result<std::optional<ClickAt>> Panels::draw(ImVec2 from, ImVec2 to, const Clicks& clicks) {
  if (clicks.wanted() && enlarged_ && *enlarged_ != kCamera) enlarged_.reset();  // the camera's picture must be seen
  const auto box = boxes(from, to);
  const auto seen = [&](int panel) { return !enlarged_ || *enlarged_ == panel; };
  const std::string when = shown_ ? fmt::format("frame {}   {:.2f} s", shown_->number, shown_->t_s) : "";
  std::optional<ClickAt> click;
  if (seen(kCamera)) click = draw_camera(cell(box[kCamera], "Left camera", when), clicks);
  if (seen(kDepth)) draw_depth(cell(box[kDepth], "Depth", "metres; drag: quality"));
  if (seen(kPoints)) DUO_TRY(draw_cloud_panel(cell(box[kPoints], "Points", "drag, wheel, right click")));
  if (seen(kBody)) draw_region(cell(box[kBody], "Body", "by nearest joint"));
  if (seen(kLast) && choices_.rectified_pair)
    DUO_TRY(draw_rectified_pair(cell(box[kLast], "Rectified pair", "same rows")));
  else if (seen(kLast))
    draw_hue_panel(cell(box[kLast], "Hue and saturation", "degrees; brightness = saturation"));
  take_double_click(box, clicks);
  return click;
}

Panels::Cell Panels::cell(const Box& box, const char* title, const std::string& note) const {
  const auto& [from, to] = box;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float title_height = kTitle * scale_, caption_height = kCaption * scale_, margin = kMargin * scale_;
  list.AddRectFilled(from, to, kPanel, 6 * scale_);
  ImGui::PushFont(title_font());
  list.PushClipRect(from, to, true);
  list.AddText({from.x + margin, from.y + 6 * scale_}, kText, title);
  list.PopClipRect();
  const float title_width = ImGui::CalcTextSize(title).x;
  ImGui::PopFont();
  const float width = ImGui::CalcTextSize(note.c_str()).x;
  if (title_width + width + 4 * margin < to.x - from.x)
    list.AddText({to.x - margin - width, from.y + 6 * scale_}, kFaint, note.c_str());
  return {{from.x + margin, from.y + title_height},
          {to.x - margin, to.y - caption_height},
          {from.x + margin, to.y - caption_height + 3 * scale_},
          to.x - from.x - 2 * margin};
}

Panels::Fit Panels::picture(const Cell& cell, const Texture& texture) {
  const float width = cell.to.x - cell.from.x, height = cell.to.y - cell.from.y;
  const auto across = static_cast<float>(std::max(texture.size().width, 1)),
             down = static_cast<float>(std::max(texture.size().height, 1));
  const float scale = std::max(0.01f, std::min(width / across, height / down));
  const ImVec2 from = {cell.from.x + (width - across * scale) / 2, cell.from.y + (height - down * scale) / 2};
  const Fit fit = {from, {from.x + across * scale, from.y + down * scale}, scale};
  texture.draw(*ImGui::GetWindowDrawList(), fit.from, fit.to);
  return fit;
}

std::optional<ClickAt> Panels::draw_camera(const Cell& cell, const Clicks& clicks) {
  if (!shown_) {
    ImGui::GetWindowDrawList()->AddText(inset(cell.from, 12 * scale_), kFaint, "waiting for the first pictures ...");
    return {};
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Fit fit = picture(cell, camera_);
  list.PushClipRect(fit.from, fit.to, true);
  draw_people(fit);
  if (clicks.wanted()) draw_clicks(fit, clicks);
  list.PopClipRect();
  if (clicks.wanted())
    list.AddText({cell.caption.x, cell.caption.y + 5 * scale_}, kAccent, clicks.prompt().c_str());
  else
    put_joints(cell);
  const bool over = clicks.wanted() && ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(fit.from, fit.to);
  pressed_ = pressed_ || (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left));
  const bool let_go = pressed_ && !ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (let_go) pressed_ = false;
  if (!over) return {};
  const ImVec2 mouse = ImGui::GetMousePos();
  text_on_picture(list, {mouse.x + 14 * scale_, mouse.y + 10 * scale_}, kText, clicks.name(clicks.made().size()).c_str());
  list.AddCircle(mouse, 7 * scale_, kAccent, 0, 2 * scale_);
  if (!let_go) return {};
  return ClickAt{(mouse.x - fit.from.x) / fit.scale - 0.5, (mouse.y - fit.from.y) / fit.scale - 0.5};
}

/// Bones, boxes and rings of one sigma; broken where a joint is not seen.
void Panels::draw_people(const Fit& fit) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float thick = 4 * scale_, dash = 7 * scale_;
  const Shapes shapes = shapes_of(shown_->people, header_);
  for (const Shapes::Line& bone : shapes.bones) {
    const ImVec2 from = fit.place(bone.x0_px, bone.y0_px), to = fit.place(bone.x1_px, bone.y1_px);
    if (bone.thin)
      list.AddLine(from, to, bone.broken ? kFaint : kAccent, thick / 2);
    else if (bone.broken)
      dashed_line(list, from, to, kBone, thick, dash);
    else
      list.AddLine(from, to, kBone, thick);
  }
  for (const Shapes::Mark& joint : shapes.joints) {
    const ImVec2 at = fit.place(joint.x_px, joint.y_px);
    const float half = fit.scale * static_cast<float>(joint.half_px), ring = fit.scale * static_cast<float>(joint.sigma_px);
    const ImVec2 corners[] = {
        {at.x - half, at.y - half}, {at.x + half, at.y - half}, {at.x + half, at.y + half}, {at.x - half, at.y + half}};
    if (joint.broken) {
      for (std::size_t i = 0; i < 4; ++i) dashed_line(list, corners[i], corners[(i + 1) % 4], kBox, 2.5f * scale_, dash / 2);
      dashed_circle(list, at, ring, IM_COL32(255, 255, 255, 150), 1.5f * scale_, dash / 2);
    } else {
      list.AddRect(corners[0], corners[2], kBox, 2 * scale_, 0, 2.5f * scale_);
      list.AddCircle(at, ring, IM_COL32(255, 255, 255, 190), 0, 1.5f * scale_);
      list.AddCircleFilled(at, 4 * scale_, kBox);
    }
  }
}

void Panels::draw_clicks(const Fit& fit, const Clicks& clicks) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::size_t i = 0; i < clicks.made().size(); ++i) {
    const ImVec2 at = fit.place(clicks.made()[i].x_px, clicks.made()[i].y_px);
    if (clicks.joined(i))
      list.AddLine(fit.place(clicks.made()[i - 1].x_px, clicks.made()[i - 1].y_px), at, IM_COL32(82, 168, 255, 150),
                   2 * scale_);
    list.AddCircleFilled(at, 4 * scale_, kAccent);
    list.AddCircle(at, 9 * scale_, kAccent, 0, 2 * scale_);
    text_on_picture(list, {at.x + 14 * scale_, at.y - 8 * scale_}, kText, clicks.name(i).c_str());
  }
}

/// "hand 1.32 m ±2 cm" for each joint of an arm, "person 1: 18 of 21 joints seen" for a body, side by side; where that is too
/// wide, without the sigma, and cut.
void Panels::put_joints(const Cell& cell) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::vector<Label> labels;
  for (const Person& person : shown_->people)
    for (const Label& label : labels_of(person, header_.metric)) labels.push_back(label);
  const float width = cell.caption_width / static_cast<float>(std::max<std::size_t>(labels.size(), 1));
  float x = cell.caption.x;
  for (const Label& label : labels) {
    const std::string exact = label.sigma.empty() ? label.text : fmt::format("{} \u00b1{}", label.text, label.sigma);
    const bool fits = ImGui::CalcTextSize(exact.c_str()).x < width;
    list.PushClipRect({x, cell.caption.y}, {x + width, cell.caption.y + kCaption * scale_}, true);
    list.AddText({x, cell.caption.y + 5 * scale_}, color_of(label.state), (fits ? exact : label.text).c_str());
    list.PopClipRect();
    x += width;
  }
}

void Panels::turn_cloud(const Cell& cell) {
  constexpr double kRadiansPerPixel = 0.008, kMost_rad = 1.5;
  ImGui::SetCursorScreenPos(cell.from);
  ImGui::InvisibleButton("points", {cell.to.x - cell.from.x, cell.to.y - cell.from.y});
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActive() && !ImGui::IsItemActivated()) {  // not the way to where the button went down
    orbit_.yaw_rad = std::clamp(orbit_.yaw_rad - kRadiansPerPixel * io.MouseDelta.x / scale_, -kMost_rad, kMost_rad);
    orbit_.pitch_rad = std::clamp(orbit_.pitch_rad + kRadiansPerPixel * io.MouseDelta.y / scale_, -kMost_rad, kMost_rad);
  }
  if (!ImGui::IsItemHovered()) return;
  orbit_.zoom = std::clamp(orbit_.zoom * std::pow(1.15, io.MouseWheel), 0.3, 6.0);
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right))
    orbit_ = {.middle_m = std::max(0.3, foreground_m(shown_->frame->disparity.d_q4, header_.rectified))};
}

Result<void> Panels::draw_cloud_panel(const Cell& cell) {
  const Size size = {static_cast<int>(cell.to.x - cell.from.x),
                     static_cast<int>(cell.to.y + (kCaption - kMargin) * scale_ - cell.from.y)};
  if (!shown_ || size.width < 8 || size.height < 8) return {};
  Cell tall = cell;
  tall.to.y += (kCaption - kMargin) * scale_;  // no caption
  turn_cloud(tall);
  const OrbitCamera camera(orbit_, header_.rectified, size);
  if (cloud_stale_ || orbit_ != drawn_orbit_ || points_.size() != size) {
    if (points_.size() != size) points_ = Image<Rgb8>(size);
    draw_points(shown_->frame->disparity.d_q4, shown_->frame->color, header_.rectified, camera, points_);
    DUO_TRY(cloud_.set(points_));
    drawn_orbit_ = orbit_;
    cloud_stale_ = false;
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Fit fit = picture(tall, cloud_);
  list.PushClipRect(fit.from, fit.to, true);
  for (const Person& person : shown_->people) {
    std::vector<std::optional<ImVec2>> places(person.count());
    for (std::size_t j = 0; j < places.size(); ++j)
      if (person.joints[j].state != JointState::kLost)
        if (const auto at = camera.place(person.joints[j].p_in_rig_m)) places[j] = fit.place(at->x, at->y);
    for (std::size_t j = 0; j < places.size(); ++j) {
      const int parent = person.skeleton->joints[j].parent;
      const auto from = parent < 0 ? std::nullopt : places[static_cast<std::size_t>(parent)];
      const float thick = is_finger(person.skeleton->joints[j].id) ? 1.5f : 3.5f;
      if (from && places[j]) list.AddLine(*from, *places[j], kBone, thick * scale_);
    }
    for (std::size_t j = 0; j < places.size(); ++j)
      if (places[j])
        list.AddCircleFilled(*places[j], (is_finger(person.skeleton->joints[j].id) ? 2 : 5) * scale_,
                             color_of(person.joints[j].state));
  }
  list.PopClipRect();
  return {};
}

void Panels::draw_region(const Cell& cell) {
  if (!shown_) return;
  picture(cell, region_);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto keys = shade_keys(header_);
  float words = 0, shades = 0;
  for (const ShadeKey& key : keys) {
    words += ImGui::CalcTextSize(key.name.c_str()).x + 14 * scale_;
    shades += static_cast<float>(key.joints.size());
  }
  const float shade = std::clamp((cell.caption_width - words) / std::max(shades, 1.0f), 4 * scale_, 16 * scale_);
  list.PushClipRect(cell.caption, {cell.caption.x + cell.caption_width, cell.caption.y + kCaption * scale_}, true);
  float x = cell.caption.x;
  for (const ShadeKey& key : keys) {
    for (const JointId joint : key.joints) {
      const Rgb8 c = shade_of(joint);
      list.AddRectFilled({x, cell.caption.y + 6 * scale_}, {x + shade, cell.caption.y + 20 * scale_},
                         IM_COL32(c.r, c.g, c.b, 255), 3 * scale_);
      x += shade;
    }
    list.AddText({x + 4 * scale_, cell.caption.y + 5 * scale_}, kText, key.name.c_str());
    x += 14 * scale_ + ImGui::CalcTextSize(key.name.c_str()).x;
  }
  list.PopClipRect();
}

void Panels::draw_hue_panel(const Cell& cell) {
  if (!shown_) return;
  picture(cell, hue_);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float bottom = cell.caption.y + 10 * scale_;
  hue_strip_.draw(list, cell.caption, {cell.caption.x + cell.caption_width, bottom});
  const int step = cell.caption_width > 200 * scale_ ? 60 : 120;  // as many as have room
  for (int degrees = 0; degrees < 360; degrees += step) {
    const float x = cell.caption.x + static_cast<float>(degrees) * cell.caption_width / 360;
    list.AddText({x, bottom + 3 * scale_}, kText, std::to_string(degrees).c_str());
  }
}

}  // namespace duo::app::view
