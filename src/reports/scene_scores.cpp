#include <fmt/format.h>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

/// By threshold.
nlohmann::json means_of(const MethodScores& method) {
  nlohmann::json out = {{"bad_filled_percent", nlohmann::json::array()}, {"bad_holes_percent", nlohmann::json::array()}};
  for (std::size_t t = 0; t < kBadThresholds_px.size(); ++t) {
    out["bad_filled_percent"].push_back(method.filled_percent(t));
    out["bad_holes_percent"].push_back(method.holes_bad_percent(t));
  }
  return out;
}

nlohmann::json report_json(const MethodScores& method) {
  nlohmann::json scenes = nlohmann::json::array();
  for (const SceneScore& s : method.scenes)
    scenes.push_back({{"scene", s.scene},
                      {"bad_filled_percent", s.score.bad_filled},
                      {"bad_holes_percent", s.score.bad_holes},
                      {"average_error_px", s.score.average_error_px},
                      {"coverage_percent", s.score.coverage_percent},
                      {"ms", s.ms}});
  nlohmann::json out = {{"method", method.method}, {"scenes", scenes}};
  out["mean"] = means_of(method);
  if (method.has_v2()) out["v2_mean"] = means_of(method.v2());
  return out;
}

std::string text_of_ours(const MethodScores& ours) {
  std::string text = fmt::format("{}: bad pixels in %, nonocc / all / disc\n", ours.method);
  text += fmt::format("{:<10}  {:^19}  {:^19}  {:^19}  {:^19}  {:>7}  {:>8}  {:>6}\n", "scene", "bad-1.0 filled",
                      "bad-1.0 holes bad", "bad-0.5 filled", "bad-2.0 filled", "avg px", "coverage", "ms");
  const auto cell = [](const std::array<double, 3>& p) { return fmt::format("{:5.1f}  {:5.1f}  {:5.1f}", p[0], p[1], p[2]); };
  for (const SceneScore& s : ours.scenes)
    text += fmt::format("{:<10}  {}  {}  {}  {}  {:7.2f}  {:7.1f}%  {:6.1f}\n", s.scene, cell(s.score.bad_filled[1]),
                        cell(s.score.bad_holes[1]), cell(s.score.bad_filled[0]), cell(s.score.bad_filled[2]),
                        s.score.average_error_px, s.score.coverage_percent, s.ms);
  return text;
}

std::string text_of_means(const std::vector<MethodScores>& methods, const std::string& of) {
  std::string text =
      fmt::format("\nMean over {} (nonocc, all and disc of each scene):\n{:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", of, "",
                  "1 filled", "1 holes", ".5 filled", ".5 holes", "2 filled", "2 holes");
  for (const MethodScores& m : methods) {
    text += fmt::format("{:<28}", m.method);
    for (const std::size_t threshold : {1, 0, 2})
      text += fmt::format(" {:9.2f} {:9.2f}", m.filled_percent(threshold), m.holes_bad_percent(threshold));
    text += "\n";
  }
  return text;
}

std::string text_of_v2_means(const std::vector<MethodScores>& methods) {
  std::vector<MethodScores> of_v2;
  for (const MethodScores& m : methods) of_v2.push_back(m.v2());
  std::string text = text_of_means(of_v2, "tsukuba, venus, teddy, cones: the version-2 mean");
  text += fmt::format("{:<28} {:9.2f}   as printed there:", "thesis of 2010", kThesisMean_percent);
  for (const auto& [scene, p] : thesis_percent()) text += fmt::format(" {} {:.1f} {:.1f} {:.1f}", scene, p[0], p[1], p[2]);
  return text + "\n\"tuned\" is the best of a grid search on these four scenes; it flatters OpenCV.\n";
}

}  // namespace

std::string json_of(const std::vector<MethodScores>& methods, const std::vector<SceneGroup>& groups) {
  nlohmann::json out = {
      {"thresholds_px", kBadThresholds_px}, {"regions", {"nonocc", "all", "disc"}}, {"methods", nlohmann::json::array()}};
  for (const MethodScores& m : methods) out["methods"].push_back(report_json(m));
  if (methods[0].has_v2()) out["thesis_v2_mean_percent"] = kThesisMean_percent;
  for (const SceneGroup& group : groups) {
    nlohmann::json of_methods = nlohmann::json::array();
    for (const MethodScores& m : methods)
      of_methods.push_back({{"method", m.method}, {"mean", means_of(m.part(group.begin, group.end))}});
    out["folders"].push_back({{"folder", group.name}, {"methods", of_methods}});
  }
  return json_text(out);
}

std::string text_of(const std::vector<MethodScores>& methods, const std::vector<SceneGroup>& groups) {
  const bool v2 = methods[0].has_v2();
  std::string text = text_of_ours(methods[0]);
  if (v2) text += text_of_v2_means(methods);
  for (const SceneGroup& group : groups) {
    std::vector<MethodScores> of_group;
    for (const MethodScores& m : methods) of_group.push_back(m.part(group.begin, group.end));
    text += text_of_means(of_group, "the scenes of " + group.name);
  }
  if (!v2 || methods[0].scenes.size() > thesis_percent().size()) text += text_of_means(methods, "all scenes");
  return text;
}

std::string heading_of_faults(const std::vector<MethodScores>& clean) {
  std::string text = fmt::format(
      "Bad-1.0 in %, holes filled by the scorer / holes bad, mean over all scenes and regions; with a fault: what is "
      "added\n{:<16}",
      "");
  for (const MethodScores& m : clean) text += fmt::format(" {:>24}", m.method);
  text += fmt::format("\n{:<16}", "as they are");
  for (const MethodScores& m : clean)
    text += fmt::format(" {:>24}", fmt::format("{:.2f} / {:.2f}", m.filled_percent(1), m.holes_bad_percent(1)));
  return text + "\n";
}

std::string text_of(const FaultScores& fault, const std::vector<MethodScores>& clean) {
  std::string text = fmt::format("{:<16}", fault.name);
  for (std::size_t i = 0; i < clean.size(); ++i)
    text +=
        fmt::format(" {:>24}", fmt::format("{:+.2f} / {:+.2f}", fault.methods[i].filled_percent(1) - clean[i].filled_percent(1),
                                           fault.methods[i].holes_bad_percent(1) - clean[i].holes_bad_percent(1)));
  return text + "\n";
}

std::string json_of(const std::vector<FaultScores>& faults, const std::vector<MethodScores>& clean) {
  nlohmann::json base = nlohmann::json::array(), rows = nlohmann::json::array();
  for (const MethodScores& m : clean) base.push_back(report_json(m));
  for (const FaultScores& fault : faults) {
    nlohmann::json row = {{"fault", fault.name}, {"methods", nlohmann::json::array()}};
    for (std::size_t i = 0; i < clean.size(); ++i)
      row["methods"].push_back(
          {{"method", clean[i].method},
           {"added_filled_percent", fault.methods[i].filled_percent(1) - clean[i].filled_percent(1)},
           {"added_holes_percent", fault.methods[i].holes_bad_percent(1) - clean[i].holes_bad_percent(1)}});
    rows.push_back(row);
  }
  return json_text({{"clean", base}, {"perturbed", rows}});
}

}  // namespace duo
