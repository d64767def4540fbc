// What can be chosen by name: a table a kind, edited by hand.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "duoptic/engine.h"
#include "duoptic/tracker.h"
#include "engines/engines.h"
#include "matchers/pyramid/pyramid_params.h"
#include "matchers/sgm/sgm_params.h"
#include "trackers/arm/arm_tracker.h"
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

std::vector<std::string> matcher_names() { return {"sgm", "pyramid"}; }

std::vector<std::string> matcher_presets(std::string_view matcher) {
  if (matcher == "sgm") return {std::begin(kSgmPresets), std::end(kSgmPresets)};
  if (matcher == "pyramid") return {std::begin(kPyramidPresets), std::end(kPyramidPresets)};
  return {};
}

namespace {

template <class Params>
std::vector<ParameterInfo> described(const Params& params, std::span<const Parameter<Params>> table) {
  std::vector<ParameterInfo> out;
  for (const auto& p : table) out.push_back({p.name, p.unit, p.help, double(params.*p.member), double(p.min), double(p.max)});
  return out;
}

}  // namespace

Result<std::vector<ParameterInfo>> matcher_parameters(std::string_view matcher, std::string_view preset) {
  if (matcher == "sgm") {
    DUO_TRY_ASSIGN(const SgmParams params, sgm_params(preset, {}));
    return described<SgmParams>(params, kSgmParameters);
  }
  if (matcher == "pyramid") {
    DUO_TRY_ASSIGN(const PyramidParams params, pyramid_params(preset, {}));
    return described<PyramidParams>(params, kPyramidParameters);
  }
  return Error{ErrorCode::kBadInput,
               fmt::format("list parameters: no matcher is called \"{}\"; choose one of: sgm, pyramid", matcher)};
}

namespace {

struct KnownTracker {
  std::string_view name;
  std::unique_ptr<Tracker> (*make)();
};
constexpr KnownTracker kTrackers[] = {{"arm", make_arm_tracker}, {"thesis", make_thesis_tracker}};

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
