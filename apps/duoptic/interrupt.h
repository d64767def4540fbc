// Ctrl-C as a question that a loop asks, instead of the end of the program.
#pragma once

#include <csignal>
#include <ctime>

namespace duo::app {

/// While it lives, Ctrl-C (or SIGTERM) is remembered; one that comes a second or more after the first ends the program as
/// ever. Some programs send the signal twice at once. One object at a time.
class Interrupt {
 public:
  Interrupt() {
    asked_ = 0;
    struct sigaction action {};
    action.sa_handler = [](int signal) {
      timespec now{};
      clock_gettime(CLOCK_MONOTONIC, &now);
      if (asked_ == 0) first_s_ = static_cast<std::sig_atomic_t>(now.tv_sec);
      asked_ = 1;
      if (static_cast<std::sig_atomic_t>(now.tv_sec) - first_s_ < 2) return;
      std::signal(signal, SIG_DFL);
      std::raise(signal);
    };
    sigaction(SIGINT, &action, &before_int_);
    sigaction(SIGTERM, &action, &before_term_);
  }
  ~Interrupt() {
    sigaction(SIGINT, &before_int_, nullptr);
    sigaction(SIGTERM, &before_term_, nullptr);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  static bool asked() { return asked_ != 0; }

 private:
  inline static volatile std::sig_atomic_t asked_ = 0, first_s_ = 0;
  struct sigaction before_int_ {
  }, before_term_{};
};

}  // namespace duo::app
