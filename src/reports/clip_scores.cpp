#include <fmt/format.h>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

nlohmann::json report_json(const ClipScore& score) {
  nlohmann::json joints = nlohmann::json::object();
  for (const auto& [id, s] : score.joints)
    joints[std::string(name_of(id))] = {{"median_mm", or_null(s.median_mm)},
                                        {"p95_mm", or_null(s.p95_mm)},
                                        {"lost_or_off_percent", or_null(s.bad_percent)},
                                        {"frames_to_recover", or_null(s.frames_to_recover)},
                                        {"recovered", s.recovered},
                                        {"hidden_median_mm", or_null(s.hidden_median_mm)},
                                        {"hidden_lost_percent", or_null(s.hidden_lost_percent)},
                                        {"hidden_false_percent", or_null(s.hidden_false_percent)},
                                        {"inside_3_sigma_percent", or_null(s.inside_3_sigma_percent)}};
  nlohmann::json out = {{"clip", score.clip},         {"tracker", score.tracker},
                        {"first_frame", score.first}, {"frames", score.frames},
                        {"left_out", score.left_out}, {"fps", score.fps},
                        {"joints", joints},           {"depth", nullptr},
                        {"people", score.people},     {"identity_switches", score.identity_switches}};
  if (const auto& d = score.depth)
    out["depth"] = {{"coverage_percent", d->coverage_percent},
                    {"bad_percent", d->bad_percent},
                    {"median_px", d->median_px},
                    {"median_depth_percent", d->median_depth_percent},
                    {"bias_px", d->bias_px},
                    {"background_bias_px", d->background_bias_px}};
  return out;
}

std::string cell(const std::optional<double>& value, int digits, const char* unit) {
  return value ? fmt::format("{:.{}f}{}", *value, digits, unit) : "-";
}

std::string lines_of_clip(const ClipScore& score) {
  std::string text;
  for (const auto& [id, s] : score.joints) {
    const bool first = id == score.joints[0].first;
    const std::string recover =
        s.frames_to_recover ? fmt::format("{}{}", s.recovered ? "" : ">", *s.frames_to_recover) : std::string("-");
    text +=
        fmt::format("{:<18} {:<8} {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", first ? score.clip : "",
                    first ? score.tracker : "", name_of(id), cell(s.median_mm, 1, ""), cell(s.p95_mm, 1, ""),
                    cell(s.bad_percent, 1, "%"), recover, cell(s.hidden_median_mm, 1, ""), cell(s.hidden_lost_percent, 1, "%"),
                    cell(s.hidden_false_percent, 1, "%"), cell(s.inside_3_sigma_percent, 1, "%"));
  }
  text += fmt::format("{:<27} {} frames from {}, {:.1f} frames/s", "", score.frames, score.first, score.fps);
  if (score.left_out > 0) text += fmt::format(", {} without a pair left out", score.left_out);
  if (score.people > 1) text += fmt::format(", {} people, {} identity switches", score.people, score.identity_switches);
  if (score.depth)
    text += fmt::format(
        "; depth on the person: {:.1f} % covered, {:.1f} % off by more than 1 px, median {:.2f} px = {:.2f} %, "
        "bias {:+.3f} px, on the background {:+.3f} px",
        score.depth->coverage_percent, score.depth->bad_percent, score.depth->median_px, score.depth->median_depth_percent,
        score.depth->bias_px, score.depth->background_bias_px);
  return text + "\n";
}

}  // namespace

std::string text_of(std::span<const ClipScore> scores) {
  std::string text = fmt::format("{:<18} {:<8} {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "clip", "tracker",
                                 "joint", "median", "p95", "bad", "recover", "hidden", "h.lost", "h.false", "3 sigma");
  for (const ClipScore& score : scores) text += lines_of_clip(score);
  return text;
}

std::string json_of(std::span<const ClipScore> scores, double jitter_px, const std::string& rig) {
  nlohmann::json out = {{"bad_mm", kBadJoint_mm}, {"jitter_px", jitter_px}, {"rig", rig}, {"clips", nlohmann::json::array()}};
  for (const ClipScore& score : scores) out["clips"].push_back(report_json(score));
  return json_text(out);
}

}  // namespace duo
