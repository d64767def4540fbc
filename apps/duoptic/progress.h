// How far a command is, on stderr.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

#include "command.h"

namespace duo::app {

/// Tells how far it is: over and over on a terminal, every few seconds elsewhere.
class Progress {
 public:
  Progress(const CLI::App& app, std::int64_t count, bool quiet) : app_(app), count_(count), quiet_(quiet) {}
  ~Progress() {
    if (shown_ && terminal_) put_on_stderr("\r\033[K");
  }
  void frame(std::int64_t number) {
    const auto now = Clock::now();
    if (quiet_ || now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(5))) return;
    last_ = now;
    shown_ = true;
    const std::string line = count_ > 0 ? fmt::format("frame {} of {}", number, count_) : fmt::format("frame {}", number);
    if (terminal_)
      put_on_stderr(fmt::format("\rduoptic {}: {}", app_.get_name(), line));
    else
      say(app_, line);
  }

 private:
  using Clock = std::chrono::steady_clock;
  const CLI::App& app_;
  std::int64_t count_;
  bool quiet_, terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace duo::app
