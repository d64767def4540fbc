#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

double share_percent(std::int64_t part, std::int64_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(all, 1));
}

nlohmann::json report_json(const LightCounts& c) {
  return {{"pixels", c.pixels},
          {"known_percent", share_percent(c.known, c.pixels)},
          {"unlit_percent", share_percent(c.unlit, c.pixels)},
          {"saturated_percent", share_percent(c.saturated, c.pixels)},
          {"uncertain_percent", share_percent(c.uncertain, c.pixels)}};
}

/// Dark rooms are best for patterns, but leave matchers nothing to see.
bool is_dark(const Image<Rgb8>& picture) {
  constexpr double kDark = 25;
  double sum = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) sum += picture.at(y, x).g;
  return sum < kDark * picture.width() * picture.height();
}

}  // namespace

std::string json_of(const LightCode& code, const std::string& folder) {
  return json_text({{"folder", folder},
                    {"patterns", light_patterns(code).size()},
                    {"screen", {code.screen.width, code.screen.height}},
                    {"period_px", code.period_px}});
}

std::string json_of(const LightTruth& truth, std::size_t patterns, std::size_t exposures, const std::string& folder) {
  const Size size = truth.disparity_px.size();
  return json_text({{"scene", folder},
                    {"width", size.width},
                    {"height", size.height},
                    {"patterns", patterns},
                    {"exposures", exposures},
                    {"disparities", truth.matched},
                    {"coverage_percent", share_percent(truth.matched, truth.inside)},
                    {"contradicting", truth.contradicting},
                    {"rows_px", truth.rows_px},
                    {"left", report_json(truth.left)},
                    {"right", report_json(truth.right)}});
}

std::string text_of(const LightTruth& truth, const std::string& folder) {
  const Size size = truth.disparity_px.size();
  std::string text;
  for (const auto& [name, c] : {std::pair{"left", truth.left}, {"right", truth.right}})
    text += fmt::format("{:<6} {:5.1f} % lit and told apart, {:.1f} % too dark, {:.1f} % too bright, {:.1f} % in doubt\n", name,
                        share_percent(c.known, c.pixels), share_percent(c.unlit, c.pixels),
                        share_percent(c.saturated, c.pixels), share_percent(c.uncertain, c.pixels));
  text += fmt::format("truth  {:5.1f} % of the left picture; rows disagree by {:.2f} px at the median; {}x{}, written to {}\n",
                      share_percent(truth.matched, truth.inside), truth.rows_px, size.width, size.height, folder);
  return text;
}

std::vector<std::string> warnings_of(const LightTruth& truth) {
  constexpr double kRowsMatter_px = 0.3;
  std::vector<std::string> out;
  if (std::abs(truth.rows_px) > kRowsMatter_px)
    out.push_back(
        fmt::format("the right view shows everything {:.2f} px {} than the left one: the rig does not fit; correct it by "
                    "duoptic rig refine, then decode again",
                    std::abs(truth.rows_px), truth.rows_px > 0 ? "lower" : "higher"));
  if (is_dark(truth.pair.left.pixels))
    out.emplace_back("left.png is dark, as the room was; give pictures of the same scene in ordinary light by --light");
  return out;
}

}  // namespace duo
