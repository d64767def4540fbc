#include "style.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <system_error>

namespace duo::app::view {
namespace {

constexpr char kFace[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr char kTitleFace[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";

ImFont* load(const char* path, float size) {
  static const ImWchar kLetters[] = {0x20, 0x17F, 0x2013, 0x2026, 0x2190, 0x2193, 0};  // Latin, dashes, ellipsis, arrows
  std::error_code ignored;
  ImGuiIO& io = ImGui::GetIO();
  if (std::filesystem::exists(path, ignored))
    if (ImFont* font = io.Fonts->AddFontFromFileTTF(path, size, nullptr, kLetters)) return font;
  ImFontConfig config;
  config.SizePixels = std::floor(size * 0.85f);  // its own face is wide
  return io.Fonts->AddFontDefault(&config);
}

ImVec4 rgba(ImU32 color, float alpha = 1) {
  ImVec4 out = ImGui::ColorConvertU32ToFloat4(color);
  out.w = alpha;
  return out;
}

}  // namespace

void set_style(float scale) {
  load(kFace, std::round(14 * scale));
  load(kTitleFace, std::round(14 * scale));
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 5;
  style.ChildRounding = 6;
  style.FramePadding = {9, 5};
  style.ItemSpacing = {8, 7};
  style.CellPadding = {5, 3};
  style.ScrollbarSize = 10;
  style.WindowBorderSize = style.ChildBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg] = rgba(kGround);
  style.Colors[ImGuiCol_ChildBg] = rgba(kPanel);
  style.Colors[ImGuiCol_PopupBg] = rgba(IM_COL32(36, 40, 48, 255), 0.97f);
  style.Colors[ImGuiCol_Text] = rgba(kText);
  style.Colors[ImGuiCol_TextDisabled] = rgba(kFaint);
  style.Colors[ImGuiCol_Button] = rgba(IM_COL32(48, 54, 65, 255));
  style.Colors[ImGuiCol_ButtonHovered] = rgba(IM_COL32(62, 71, 87, 255));
  style.Colors[ImGuiCol_ButtonActive] = rgba(kAccent, 0.7f);
  style.Colors[ImGuiCol_FrameBg] = rgba(IM_COL32(40, 45, 54, 255));
  style.Colors[ImGuiCol_FrameBgHovered] = rgba(IM_COL32(50, 57, 69, 255));
  style.Colors[ImGuiCol_FrameBgActive] = rgba(IM_COL32(58, 66, 80, 255));
  style.Colors[ImGuiCol_SliderGrab] = style.Colors[ImGuiCol_CheckMark] = rgba(kAccent);
  style.Colors[ImGuiCol_SliderGrabActive] = rgba(kAccent, 0.8f);
  style.Colors[ImGuiCol_Header] = rgba(IM_COL32(36, 41, 50, 255));
  style.Colors[ImGuiCol_HeaderHovered] = rgba(IM_COL32(46, 53, 65, 255));
  style.Colors[ImGuiCol_HeaderActive] = rgba(IM_COL32(52, 60, 74, 255));
  style.ScaleAllSizes(scale);
}

ImFont* title_font() {
  const auto& fonts = ImGui::GetIO().Fonts->Fonts;
  return fonts[fonts.Size > 1 ? 1 : 0];
}

void put_text(ImU32 color, const std::string& text, ImFont* font) {
  if (font != nullptr) ImGui::PushFont(font);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  if (font != nullptr) ImGui::PopFont();
}

void put_fact(const char* name, const std::string& text) {
  ImGui::TextDisabled("%s", name);
  ImGui::SameLine(ImGui::GetFontSize() * 7.5f);
  put_text(kText, text);
}

ImU32 color_of(JointState state) {
  switch (state) {
    case JointState::kSeen:
      return kBox;
    case JointState::kInferred:
      return kWarn;
    case JointState::kLost:
      return kFaint;
  }
  return kFaint;
}

ImU32 color_of(RigVerdict verdict) {
  return verdict == RigVerdict::kGood ? kBox : verdict == RigVerdict::kCanBeImproved ? kWarn : kBad;
}

void dashed_line(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 color, float thickness, float dash) {
  const ImVec2 along = {to.x - from.x, to.y - from.y};
  const float length = std::hypot(along.x, along.y);
  const auto at = [&](float way) { return ImVec2(from.x + along.x * way / length, from.y + along.y * way / length); };
  for (float way = 0; way < length; way += 2 * dash) list.AddLine(at(way), at(std::min(way + dash, length)), color, thickness);
}

void dashed_circle(ImDrawList& list, ImVec2 centre, float radius, ImU32 color, float thickness, float dash) {
  const float whole = 2 * std::numbers::pi_v<float>;
  const int dashes = std::max(4, static_cast<int>(whole * radius / (2 * dash)));
  for (int i = 0; i < dashes; ++i) {
    const float from = whole * static_cast<float>(i) / static_cast<float>(dashes);
    list.PathArcTo(centre, radius, from, from + 0.5f * whole / static_cast<float>(dashes), 6);
    list.PathStroke(color, 0, thickness);
  }
}

void text_on_picture(ImDrawList& list, ImVec2 at, ImU32 color, const char* text) {
  const ImVec2 size = ImGui::CalcTextSize(text);
  list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, IM_COL32(10, 12, 15, 170), 4);
  list.AddText(at, color, text);
}

}  // namespace duo::app::view
