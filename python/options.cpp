// Keyword arguments of the engine.
#include <algorithm>
#include <array>
#include <string_view>

#include "binding.h"
#include "duoptic/calibrate.h"

namespace duo::python {
namespace {

constexpr std::array<std::string_view, 5> kMaps = {"color", "depth", "disparity", "views", "confidence"};

}  // namespace

MatchOptions MatchOptions::take_from(py::dict& keywords) {
  MatchOptions out;
  out.engine = take<std::string>(keywords, "engine", "auto");
  out.matcher = take<std::string>(keywords, "matcher", Setup().matcher);
  out.preset = take<std::string>(keywords, "preset", Setup().preset);
  out.threads = take<int>(keywords, "threads", 0);
  for (const auto& [name, number] : take<std::map<std::string, double>>(keywords, "parameters", {}))
    out.parameters.emplace_back(name, number);
  out.max_disparity = take<std::optional<int>>(keywords, "max_disparity", std::nullopt);
  out.near_m = take<std::optional<double>>(keywords, "near_m", std::nullopt);
  out.fill = take<bool>(keywords, "fill", false);
  out.maps = take<std::optional<std::vector<std::string>>>(keywords, "maps", std::nullopt);

  if (out.threads < 0 || out.threads > 256) refuse("threads is not 0 .. 256; 0 means one per core");
  if (out.max_disparity && out.near_m) refuse("max_disparity and near_m say the same in two ways; give one of them");
  if (out.max_disparity && (*out.max_disparity < 1 || *out.max_disparity > Engine::kMaxDisparity))
    refuse("max_disparity is not 1 .. " + std::to_string(Engine::kMaxDisparity) + " px");
  for (const std::string& name : out.maps.value_or(std::vector<std::string>()))
    if (std::find(kMaps.begin(), kMaps.end(), name) == kMaps.end())
      refuse("there are no maps '" + name + "'; there are color, depth, disparity, views and confidence");
  return out;
}

Setup MatchOptions::setup(const std::optional<Rig>& rig) const {
  const auto wanted = [this](const char* name, bool otherwise) {
    return maps ? std::find(maps->begin(), maps->end(), name) != maps->end() : otherwise;
  };
  Setup setup;
  setup.rig = rig;
  setup.matcher = matcher;
  setup.preset = preset;
  setup.parameters = parameters;
  setup.fill = fill;
  if (max_disparity) setup.max_disparity = *max_disparity;
  if (near_m && !rig) refuse("near_m needs a rig; give rig, or max_disparity in its place");
  if (rig && !max_disparity)
    setup.max_disparity =
        near_m ? std::min(value(disparities_from(*rig, *near_m)), Engine::kMaxDisparity) : value(disparities_for_people(*rig));
  setup.wants = {.color = wanted("color", true),
                 .depth = wanted("depth", rig.has_value()),
                 .confidence = wanted("confidence", false),
                 .views = wanted("views", true),
                 .disparity = wanted("disparity", true)};
  if (setup.wants.depth && !rig) refuse("depth in metres needs a rig; give rig, or leave 'depth' out of maps");
  return setup;
}

}  // namespace duo::python
