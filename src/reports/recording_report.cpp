#include <fmt/format.h>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

double rate_hz(const RecordingReport& r) { return r.length_s > 0 ? static_cast<double>(r.pairs - 1) / r.length_s : 0; }

nlohmann::json report_json(const RecordedView& view) {
  return {{"codec", view.codec}, {"pictures", view.pictures}, {"missing", view.missing}};
}

}  // namespace

std::string json_of(const RecordingReport& r, const std::string& file, const std::vector<std::string>& files) {
  return json_text({{"file", file},
                    {"left", report_json(r.left)},
                    {"right", report_json(r.right)},
                    {"width", r.size.width},
                    {"height", r.size.height},
                    {"pairs", r.pairs},
                    {"length_s", r.length_s},
                    {"rate_hz", rate_hz(r)},
                    {"longest_gap_s", r.longest_gap_s},
                    {"skew_s", r.skew_s},
                    {"bytes", r.bytes},
                    {"rig", r.rig ? report_json(*r.rig) : nlohmann::json()},
                    {"date", r.date},
                    {"cut", r.cut},
                    {"files", files}});
}

std::string text_of(const RecordingReport& r) {
  std::string text =
      fmt::format("tracks   left {}, right {}, {}x{}\n", r.left.codec, r.right.codec, r.size.width, r.size.height);
  text += fmt::format("length   {} pairs in {:.2f} s, {:.2f} a second, longest gap {:.0f} ms, {:.1f} MB{}\n", r.pairs,
                      r.length_s, rate_hz(r), 1e3 * r.longest_gap_s, static_cast<double>(r.bytes) * 1e-6,
                      r.date.empty() ? "" : ", taken " + r.date);
  text += fmt::format("drops    {} left and {} right pictures were taken and are not in it\n", r.left.missing, r.right.missing);
  text += fmt::format("skew     {:.1f} ms at most between the pictures of a pair\n", 1e3 * r.skew_s);
  text += fmt::format("rig      {}\n", r.rig ? text_of(*r.rig) : "none; give --rig to the commands that need one");
  return text;
}

}  // namespace duo
