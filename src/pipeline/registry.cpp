// What can be chosen by name: a table a kind, edited by hand.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "duoptic/engine.h"
#include "duoptic/tracker.h"
#include "engines/engines.h"
#include "matchers/matchers.h"
#include "trackers/arm/arm_tracker.h"
#include "trackers/body/body_tracker.h"
#include "trackers/thesis/thesis_tracker.h"

namespace duo {

Result<std::unique_ptr<Engine>> make_engine(std::string_view name, int threads) {
  if (threads < 1 || threads > 256)
    return Error{ErrorCode::kBadInput,
                 fmt::format("make the engine: {} threads is not in 1 .. 256; leave it out for all cores", threads)};
  constexpr std::string_view kVulkan = "vulkan";
  if (name == "auto" && may_have_card())
    if (auto engine = make_vulkan_engine("", threads)) return engine;
  if (name == "simd" || name == "auto") return make_simd_engine(threads);
  if (name == "ref") return make_ref_engine();
  if (name == kVulkan) return make_vulkan_engine("", threads);
  if (name.starts_with(kVulkan) && name[kVulkan.size()] == ':')
    return make_vulkan_engine(name.substr(kVulkan.size() + 1), threads);
  return Error{ErrorCode::kBadInput,
               fmt::format("make the engine: no engine is called \"{}\"; choose one of: auto, vulkan, simd, ref", name)};
}

std::vector<std::string> matcher_names() { return Matchers::names(); }
std::vector<std::string> matcher_presets(std::string_view matcher) { return Matchers::presets(matcher); }
Result<std::vector<ParameterInfo>> matcher_parameters(std::string_view matcher, std::string_view preset) {
  return Matchers::parameters(matcher, preset);
}

namespace {

struct KnownTracker {
  std::string_view name;
  std::unique_ptr<Tracker> (*make)();
};
constexpr KnownTracker kTrackers[] = {{"body", make_body_tracker},
                                      {"body_hands", make_body_hands_tracker},
                                      {"arm", make_arm_tracker},
                                      {"thesis", make_thesis_tracker}};

}  // namespace

std::vector<std::string> tracker_names() {
  std::vector<std::string> out;
  for (const KnownTracker& tracker : kTrackers) out.emplace_back(tracker.name);
  return out;
}

Result<std::unique_ptr<Tracker>> make_tracker(std::string_view name) {
  for (const KnownTracker& tracker : kTrackers)
    if (tracker.name == name) return tracker.make();
  return Error{ErrorCode::kBadInput, fmt::format("make the tracker: no tracker is called \"{}\"; choose one of: {}", name,
                                                 fmt::join(tracker_names(), ", "))};
}

}  // namespace duo
