// duoptic devices: what the engine vulkan can compute on, and what each device lacks.
#include "duoptic/devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"

namespace duo::app::devices {
namespace {

nlohmann::json json_of(const std::vector<DeviceInfo>& devices) {
  nlohmann::json out = nlohmann::json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& d = devices[i];
    out.push_back({{"index", i},
                   {"name", d.name},
                   {"type", d.type},
                   {"driver", d.driver},
                   {"api", d.api_version},
                   {"subgroup_size", d.subgroup_size},
                   {"lacks", d.lacks}});
  }
  return out;
}

Result<Exit> run(bool json) {
  DUO_TRY_ASSIGN(const std::vector<DeviceInfo> devices, vulkan_devices());
  if (json) {
    fmt::print("{}\n", json_of(devices).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return Exit::kOk;
  }
  bool any_card = false;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& d = devices[i];
    any_card |= d.lacks.empty() && d.type != "software";
    fmt::print("{}  {}\n   {}, {}, Vulkan {}\n   {}\n", i, d.name, d.type, d.driver, d.api_version,
               d.lacks.empty() ? "has all that is needed" : fmt::format("lacks {}", fmt::join(d.lacks, ", ")));
  }
  if (!any_card) fmt::print("none of them is a usable graphics card: --engine auto computes on the CPU\n");
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("devices", "The devices that --engine vulkan can compute on, and what each lacks");
  const auto json = std::make_shared<bool>(false);
  sub->add_flag("--json", *json, "Print it as JSON");
  sub->footer("Examples:\n  duoptic devices\n  duoptic devices --json\n  duoptic track LEFT RIGHT --engine vulkan:0 ...");
  return {sub, [json] { return run(*json); }};
}

}  // namespace duo::app::devices
