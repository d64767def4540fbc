#include "archive/summarize.h"

#include <fstream>
#include <string>

#include "archive/layout.h"

namespace duo {

nlohmann::json summarize_tracks(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::int64_t frames = 0, people = 0;
  nlohmann::json joints = nlohmann::json::object();
  for (std::string text; std::getline(file, text);) {
    const nlohmann::json line = nlohmann::json::parse(text, nullptr, false);
    if (!line.is_object()) return nullptr;
    if (line.value("type", "") != "frame") continue;
    ++frames;
    const auto found = line.find("people");
    if (found == line.end() || !found->is_array()) return nullptr;
    for (const nlohmann::json& person : *found) {
      ++people;
      const auto all = person.find("joints");
      if (all == person.end()) continue;
      for (const auto& [name, joint] : all->items()) {
        nlohmann::json& counts = joints[name];
        if (counts.is_null()) counts = {{"seen", 0}, {"inferred", 0}, {"lost", 0}};
        const std::string state = joint.value("state", "lost");
        counts[state] = counts.value(state, 0) + 1;
      }
    }
  }
  return {{"frames", frames}, {"people", people}, {"joints", joints}};
}

nlohmann::json summarize_depth(const std::filesystem::path& said) {
  const nlohmann::json json = read_json_object(said);
  if (!json.is_object()) return nullptr;
  nlohmann::json out = {{"frames", json.value("frames", std::int64_t{0})},
                        {"coverage_percent", json.value("coverage_percent", 0.0)}};
  const auto fit = json.find("rig_fit");
  if (fit != json.end() && fit->is_object()) out["rig"] = fit->value("verdict", "");
  return out;
}

}  // namespace duo
