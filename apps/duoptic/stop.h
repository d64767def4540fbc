// Ctrl-C as a wish: what is being written is finished first.
#pragma once

#include <csignal>

namespace duo::app {

/// While one of these lives, SIGINT and SIGTERM are only noted; a second one ends the program as ever.
class StopOnSignal {
 public:
  StopOnSignal() {
    asked_ = 0;
    struct sigaction note {};
    note.sa_handler = [](int) { asked_ = 1; };
    note.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &note, &interrupt_);
    sigaction(SIGTERM, &note, &terminate_);
  }
  ~StopOnSignal() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  bool asked() const { return asked_ != 0; }

 private:
  inline static volatile std::sig_atomic_t asked_ = 0;
  struct sigaction interrupt_ {
  }, terminate_{};
};

}  // namespace duo::app
