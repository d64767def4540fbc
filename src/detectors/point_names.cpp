#include "core/check.h"
#include "duoptic/detector.h"

namespace duo {
namespace {

constexpr std::array<std::string_view, kBodyPoints> kBodyPointNames = {
    "nose",        "left_eye_inner", "left_eye",    "left_eye_outer",  "right_eye_inner", "right_eye",      "right_eye_outer",
    "left_ear",    "right_ear",      "mouth_left",  "mouth_right",     "left_shoulder",   "right_shoulder", "left_elbow",
    "right_elbow", "left_wrist",     "right_wrist", "left_pinky",      "right_pinky",     "left_index",     "right_index",
    "left_thumb",  "right_thumb",    "left_hip",    "right_hip",       "left_knee",       "right_knee",     "left_ankle",
    "right_ankle", "left_heel",      "right_heel",  "left_foot_index", "right_foot_index"};

constexpr std::array<std::string_view, kHandPoints> kHandPointNames = {
    "wrist",     "thumb_cmc", "thumb_mcp",  "thumb_ip",   "thumb_tip",  "index_mcp",  "index_pip",
    "index_dip", "index_tip", "middle_mcp", "middle_pip", "middle_dip", "middle_tip", "ring_mcp",
    "ring_pip",  "ring_dip",  "ring_tip",   "pinky_mcp",  "pinky_pip",  "pinky_dip",  "pinky_tip"};

}  // namespace

std::string_view name_of(BodyPoint point) { return kBodyPointNames[static_cast<std::size_t>(point)]; }

std::string_view hand_point_name(std::size_t point) {
  DUO_CHECK(point < kHandPoints);
  return kHandPointNames[point];
}

}  // namespace duo
