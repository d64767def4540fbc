// duoptic cameras: what is plugged in, and which two go together.
#include "duoptic/cameras.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"

namespace duo::app::cameras {
namespace {

nlohmann::json json_of(const std::vector<CameraInfo>& cameras, const std::vector<CameraPair>& pairs, const CameraWish& wish) {
  nlohmann::json out = {{"cameras", nlohmann::json::array()}, {"pairs", nlohmann::json::array()}};
  for (const CameraInfo& camera : cameras) {
    nlohmann::json modes = nlohmann::json::array();
    for (const CameraMode& mode : camera.modes)
      modes.push_back(
          {{"format", mode.format}, {"width", mode.size.width}, {"height", mode.size.height}, {"rates_hz", mode.rates_hz}});
    out["cameras"].push_back({{"source", source_name(camera)},
                              {"path", camera.path},
                              {"name", camera.name},
                              {"bus_path", camera.bus_path},
                              {"serial", camera.serial},
                              {"usb_mbit_s", camera.usb_mbit_s},
                              {"modes", modes}});
  }
  for (const CameraPair& pair : pairs)
    out["pairs"].push_back({{"left", source_name(cameras[pair.left])},
                            {"right", source_name(cameras[pair.right])},
                            {"format", pair.format},
                            {"width", wish.size.width},
                            {"height", wish.size.height},
                            {"rate_hz", wish.rate_hz}});
  return out;
}

void print_camera(const CameraInfo& camera) {
  fmt::print("{}  {}\n  on {}{}{}\n", source_name(camera), camera.name, camera.bus_path,
             camera.serial.empty() ? "" : ", serial " + camera.serial,
             camera.usb_mbit_s > 0 ? fmt::format(", {} Mbit/s", camera.usb_mbit_s) : "");
  for (const CameraMode& mode : camera.modes)
    fmt::print("  {} {}x{}{}\n", mode.format, mode.size.width, mode.size.height,
               mode.rates_hz.empty() ? "" : fmt::format(" at {:g} Hz", fmt::join(mode.rates_hz, ", ")));
}

Result<Exit> run(bool json) {
  const CameraWish wish;
  DUO_TRY_ASSIGN(const std::vector<CameraInfo> cameras, find_cameras());
  const std::vector<CameraPair> pairs = camera_pairs(cameras, wish);
  if (json) {
    fmt::print("{}\n", json_of(cameras, pairs, wish).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return Exit::kOk;
  }
  for (const CameraInfo& camera : cameras) print_camera(camera);
  for (const CameraPair& pair : pairs)
    fmt::print("together: {} {}, {}x{} at {:g} Hz as {}\n", source_name(cameras[pair.left]), source_name(cameras[pair.right]),
               wish.size.width, wish.size.height, wish.rate_hz, pair.format);
  if (pairs.empty()) fmt::print("no two of them give {}x{} in a format that is read here\n", wish.size.width, wish.size.height);
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("cameras", "The cameras that are plugged in, and which two go together");
  const auto json = std::make_shared<bool>(false);
  sub->add_flag("--json", *json, "Print it as JSON");
  sub->footer("Examples:\n  duoptic cameras\n  duoptic track camera:0 camera:2 --rig rig.json --select ...");
  return {sub, [json] { return run(*json); }};
}

}  // namespace duo::app::cameras
