// Ctrl-C as a question that a loop asks, instead of the end of the program.
#pragma once

#include <csignal>
#include <ctime>

namespace [[gnu::visibility("default")]] duo {

/// Ctrl-C, SIGTERM and SIGHUP. A loop that asks ends after its whole frames, and outputs are finished; the exit code is then
/// 128 and the signal's number. A signal that comes a second or more after the first ends the program as ever: some programs
/// send it twice at once.
class Interrupt {
 public:
  /// From now on signals are remembered. SIGHUP stays ignored where the caller ignores it, as nohup does; SIGINT does not: a
  /// script's shell ignores it for all that it starts in the background, and the script is who sends it.
  static void listen() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction action {};
      if (sigaction(signal, nullptr, &action) != 0 || (signal == SIGHUP && action.sa_handler == SIG_IGN)) continue;
      action = {};
      action.sa_handler = remember;
      sigaction(signal, &action, nullptr);
    }
  }
  /// For commands that write no file: a signal ends them at once.
  static void end_at_once() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction action {};
      if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == remember) std::signal(signal, SIG_DFL);
    }
    if (asked()) std::raise(signal_);
  }
  static bool asked() { return signal_ != 0; }
  /// Live sources and windows run until it: then it is no failure.
  static void is_the_end() { is_the_end_ = true; }
  /// What the program exits with on its account; 0: nothing.
  static int exit_code() { return asked() && !is_the_end_ ? 128 + signal_ : 0; }

 private:
  static void remember(int signal) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (signal_ == 0) {
      first_s_ = static_cast<std::sig_atomic_t>(now.tv_sec);
      signal_ = signal;
    }
    if (static_cast<std::sig_atomic_t>(now.tv_sec) - first_s_ < 2) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

  inline static volatile std::sig_atomic_t signal_ = 0, first_s_ = 0;
  inline static bool is_the_end_ = false;
};

}  // namespace duo
