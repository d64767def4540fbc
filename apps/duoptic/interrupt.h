// Ctrl-C as a question that a loop asks, instead of the end of the program.
#pragma once

#include <csignal>

namespace duo::app {

/// While it lives, the first Ctrl-C (or SIGTERM) is remembered; the second one ends the program as ever. One at a time.
class Interrupt {
 public:
  Interrupt() {
    asked_ = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { asked_ = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
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
  inline static volatile std::sig_atomic_t asked_ = 0;
  struct sigaction before_int_ {
  }, before_term_{};
};

}  // namespace duo::app
