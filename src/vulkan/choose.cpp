#include "vulkan/choose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace duo::vk {
namespace {

int rank_of(const DeviceInfo& info) {
  if (!info.lacks.empty() || info.type == "software") return 0;
  return info.type == "discrete" ? 4 : info.type == "integrated" ? 3 : info.type == "virtual" ? 2 : 1;
}

bool contains(std::string_view name, std::string_view part) {
  const auto lower = [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; };
  return std::search(name.begin(), name.end(), part.begin(), part.end(),
                     [&](char a, char b) { return lower(a) == lower(b); }) != name.end();
}

Error none(std::span<const PhysicalDevice> devices, std::string_view what) {
  std::string there;
  for (std::size_t i = 0; i < devices.size(); ++i)
    there += fmt::format("{}{}: {} ({})", i == 0 ? "" : ", ", i, devices[i].info.name, devices[i].info.type);
  if (there.empty()) there = "none";
  return {ErrorCode::kNotFound, fmt::format("choosing a Vulkan device: {}; there are {}: name one of them, as in "
                                            "--engine vulkan:0, or use a CPU engine",
                                            what, there)};
}

}  // namespace

Result<PhysicalDevice> choose_device(std::span<const PhysicalDevice> devices, std::string_view wanted) {
  if (wanted.empty()) {
    const auto best = std::max_element(devices.begin(), devices.end(),
                                       [](const auto& a, const auto& b) { return rank_of(a.info) < rank_of(b.info); });
    if (best == devices.end() || rank_of(best->info) == 0) return none(devices, "no graphics card has what the kernels need");
    return *best;
  }
  std::size_t index = devices.size();
  const auto [rest, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
  if (error != std::errc() || rest != wanted.data() + wanted.size())
    index = static_cast<std::size_t>(
        std::find_if(devices.begin(), devices.end(), [&](const auto& d) { return contains(d.info.name, wanted); }) -
        devices.begin());
  if (index >= devices.size()) return none(devices, fmt::format("none is \"{}\"", wanted));
  if (const DeviceInfo& info = devices[index].info; !info.lacks.empty())
    return Error{ErrorCode::kUnsupported, fmt::format("choosing Vulkan device {}: it lacks {}: update its driver, or use a CPU "
                                                      "engine",
                                                      info.name, fmt::join(info.lacks, ", "))};
  return devices[index];
}

bool has_card() {
  namespace fs = std::filesystem;
  std::error_code error;
  for (const char* node : {"/dev/nvidiactl", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"})
    if (fs::exists(node, error)) return true;
  for (const auto& entry : fs::directory_iterator("/dev/dri", error))
    if (entry.path().filename().string().starts_with("renderD")) return true;
  return false;
}

}  // namespace duo::vk
