// duoptic devices: what the engine vulkan can compute on, and what each device lacks.
#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "duoptic/reports.h"

namespace duo::app::devices {
namespace {

Result<Exit> run(bool json) {
  DUO_TRY_ASSIGN(const std::vector<DeviceInfo> devices, vulkan_devices());
  fmt::print("{}", json ? json_of(devices) + "\n" : text_of(devices));
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
