// duoptic version: what this build is and what it finds on this machine.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "duoptic/devices.h"
#include "duoptic/peers.h"

namespace duo::app::version {
namespace {

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1)
    names.emplace_back(hwy::TargetName(left & -left));
  return names;
}

Result<Exit> run(bool json) {
  const auto devices = vulkan_devices();
  if (json) {
    nlohmann::json out = {{"version", DUO_VERSION},     {"compiler", __VERSION__},     {"simd", simd_targets()},
                          {"opencv", opencv_version()}, {"matchers", matcher_names()}, {"vulkan", nlohmann::json::array()}};
    if (devices)
      for (const DeviceInfo& d : *devices)
        out["vulkan"].push_back(
            {{"name", d.name}, {"type", d.type}, {"driver", d.driver}, {"api", d.api_version}, {"lacks", d.lacks}});
    else
      out["vulkan_missing"] = devices.error().what;
    print_json(out);
    return Exit::kOk;
  }
  fmt::print("duoptic {}\ncompiler  {}\nOpenCV    {}\nSIMD      {}\n", DUO_VERSION, __VERSION__, opencv_version(),
             fmt::join(simd_targets(), " "));
  if (!devices)
    fmt::print("Vulkan    none: {}\n", devices.error().what);
  else
    for (const DeviceInfo& d : *devices)
      fmt::print("Vulkan    {} ({}, {}, {}){}\n", d.name, d.type, d.driver, d.api_version,
                 d.lacks.empty() ? "" : fmt::format(", lacks {}", fmt::join(d.lacks, ", ")));
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("version", "This build and what it finds on this machine");
  const auto json = std::make_shared<bool>(false);
  sub->add_flag("--json", *json, "Print it as JSON");
  sub->footer("Example:\n  duoptic version --json");
  return {sub, [json] { return run(*json); }};
}

}  // namespace duo::app::version
