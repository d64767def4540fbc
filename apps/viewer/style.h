// How the window looks: colours, letters, and the few shapes that ImGui lacks.
#pragma once

#include <imgui/imgui.h>

#include <string>

#include "duoptic/person.h"
#include "duoptic/rig_health.h"

namespace duo::app::view {

inline constexpr ImU32 kGround = IM_COL32(17, 19, 23, 255), kPanel = IM_COL32(26, 29, 35, 255);
inline constexpr ImU32 kText = IM_COL32(232, 234, 238, 255), kFaint = IM_COL32(140, 147, 158, 255);
inline constexpr ImU32 kAccent = IM_COL32(82, 168, 255, 255);
inline constexpr ImU32 kBox = IM_COL32(60, 230, 80, 255), kBone = IM_COL32(235, 45, 40, 255);
inline constexpr ImU32 kWarn = IM_COL32(250, 190, 60, 255), kBad = IM_COL32(255, 105, 97, 255);

/// Letters and colours of all that follows; once, before the first frame.
void set_style(float scale);
/// The same face, for titles.
ImFont* title_font();

/// A paragraph in a colour; in another face where one is given.
void put_text(ImU32 color, const std::string& text, ImFont* font = nullptr);
/// A name and what it is.
void put_fact(const char* name, const std::string& text);

/// Of a joint by its state: seen, inferred, lost.
ImU32 color_of(JointState state);
ImU32 color_of(RigVerdict verdict);

void dashed_line(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 color, float thickness, float dash);
void dashed_circle(ImDrawList& list, ImVec2 centre, float radius, ImU32 color, float thickness, float dash);
/// Text that is legible on any picture.
void text_on_picture(ImDrawList& list, ImVec2 at, ImU32 color, const char* text);

}  // namespace duo::app::view
