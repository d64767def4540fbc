// What happens to live cameras while a command runs.
#pragma once

#include <string>

#include "command.h"
#include "duoptic/pipeline.h"

namespace duo::app {

/// Says what live cameras have to tell, each time that it is something else: one is away, or cannot be locked.
class LiveNews {
 public:
  explicit LiveNews(const CLI::App& app) : app_(app) {}
  void see(const Pipeline& pipeline) {
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
