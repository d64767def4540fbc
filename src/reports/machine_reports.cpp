// What is plugged into this machine.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

std::string text_of_camera(const CameraInfo& camera) {
  std::string text = fmt::format("{}  {}\n  on {}{}{}\n", source_name(camera), camera.name, camera.bus_path,
                                 camera.serial.empty() ? "" : ", serial " + camera.serial,
                                 camera.usb_mbit_s > 0 ? fmt::format(", {} Mbit/s", camera.usb_mbit_s) : "");
  for (const CameraMode& mode : camera.modes)
    text += fmt::format("  {} {}x{}{}\n", mode.format, mode.size.width, mode.size.height,
                        mode.rates_hz.empty() ? "" : fmt::format(" at {:g} Hz", fmt::join(mode.rates_hz, ", ")));
  return text;
}

}  // namespace

std::string json_of(std::span<const CameraInfo> cameras, std::span<const CameraPair> pairs, const CameraWish& wish) {
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
  return json_text(out);
}

std::string text_of(std::span<const CameraInfo> cameras, std::span<const CameraPair> pairs, const CameraWish& wish) {
  std::string text;
  for (const CameraInfo& camera : cameras) text += text_of_camera(camera);
  for (const CameraPair& pair : pairs)
    text += fmt::format("together: {} {}, {}x{} at {:g} Hz as {}\n", source_name(cameras[pair.left]),
                        source_name(cameras[pair.right]), wish.size.width, wish.size.height, wish.rate_hz, pair.format);
  if (pairs.empty())
    text += fmt::format("no two of them give {}x{} in a format that is read here\n", wish.size.width, wish.size.height);
  return text;
}

std::string json_of(std::span<const DeviceInfo> devices) {
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
  return json_text(out);
}

std::string text_of(std::span<const DeviceInfo> devices) {
  std::string text;
  bool any_card = false;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& d = devices[i];
    any_card |= d.lacks.empty() && d.type != "software";
    text += fmt::format("{}  {}\n   {}, {}, Vulkan {}\n   {}\n", i, d.name, d.type, d.driver, d.api_version,
                        d.lacks.empty() ? "has all that is needed" : fmt::format("lacks {}", fmt::join(d.lacks, ", ")));
  }
  if (!any_card) text += "none of them is a usable graphics card: --engine auto computes on the CPU\n";
  return text;
}

}  // namespace duo
