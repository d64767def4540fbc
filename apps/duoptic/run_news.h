// What a run of pairs has to say while it goes on.
#pragma once

#include <string>

#include "command.h"
#include "duoptic/pipeline.h"

namespace duo::app {

/// The option --strict: what a run does about a rig that does not fit.
inline void add_strict_option(CLI::App& app, RigCheck& check) {
  check = RigCheck::kTell;
  app.add_flag_callback(
      "--strict", [&check] { check = RigCheck::kStrict; },
      "Stop with exit 4, and not only warn, when the first pairs (live: of any minute) show that the rig does not fit");
}

/// Says it once, each time that it is something else: of the rig, and of live cameras that one is away, or cannot be locked.
class RunNews {
 public:
  explicit RunNews(const CLI::App& app) : app_(app) {}
  void see(const Pipeline& pipeline) {
    if (const std::string& news = pipeline.rig_news(); !news.empty()) say(app_, "warning: " + news);
    if (!pipeline.live()) return;
    std::string news = pipeline.warning();
    if (news != said_ && !news.empty()) say(app_, news);
    said_ = std::move(news);
  }

 private:
  const CLI::App& app_;
  std::string said_;
};

}  // namespace duo::app
