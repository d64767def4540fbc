// duoptic cameras: what is plugged in, and which two go together.
#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "duoptic/reports.h"

namespace duo::app::cameras {
namespace {

Result<Exit> run(bool json) {
  const CameraWish wish;
  DUO_TRY_ASSIGN(const std::vector<CameraInfo> cameras, find_cameras());
  const std::vector<CameraPair> pairs = camera_pairs(cameras, wish);
  fmt::print("{}", json ? json_of(cameras, pairs, wish) + "\n" : text_of(cameras, pairs, wish));
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
