// How far a command is, on stderr.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <mutex>

#include "command.h"
#include "help.h"

namespace duo::app {

/// Tells how far it is: over and over on a terminal, every few seconds elsewhere.
///
/// Threads  any
class Progress {
 public:
  /// `count` 0: nobody knows how many there will be.
  Progress(const CLI::App& app, std::int64_t count, bool quiet, std::string each = "frame")
      : app_(app), each_(std::move(each)), count_(count), quiet_(quiet) {}
  ~Progress() { end(); }
  /// Nothing more is told.
  void end() {
    const std::lock_guard lock(mutex_);
    if (shown_ && terminal_ && !quiet_) put_on_stderr("\r\033[K");
    quiet_ = true;
  }
  void expect(std::int64_t count) {
    const std::lock_guard lock(mutex_);
    count_ = count;
  }
  void frame(std::int64_t number) {
    const std::lock_guard lock(mutex_);
    number_ = number;
    if (is_time()) tell(of_all(number));
  }
  /// Of the frame after the last one, 0 .. 1.
  void part(double done) {
    const std::lock_guard lock(mutex_);
    if (is_time()) tell(fmt::format("{}, {:.0f} %", of_all(number_ + 1), 100 * done));
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::string of_all(std::int64_t number) const {
    return count_ > 0 ? fmt::format("{} {} of {}", each_, number, count_) : fmt::format("{} {}", each_, number);
  }
  bool is_time() {
    const auto now = Clock::now();
    if (quiet_ || now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(5))) return false;
    last_ = now;
    return true;
  }
  void tell(const std::string& line) {
    shown_ = true;
    if (terminal_)
      put_on_stderr(fmt::format("\r\033[Kduoptic {}: {}", name_of(app_), line));
    else
      say(app_, line);
  }

  const CLI::App& app_;
  const std::string each_;
  std::mutex mutex_;
  std::int64_t count_, number_ = 0;
  bool quiet_, terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace duo::app
