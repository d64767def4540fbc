// Programs in processes of their own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "duoptic/result.h"

namespace duo {

/// Where a program runs, and where what it says goes; empty: where ours goes. Its stdin is empty.
struct ProcessPlace {
  std::filesystem::path folder = {}, out = {}, err = {};
};

/// A program that ends when we do, however we end: killed with this object, and by the system if this process dies.
///
/// Threads  one, which has to live as long
class Process {
 public:
  /// `words`: the program's path, or its name where PATH finds it, and its arguments.
  ///
  /// Errors  the system gives no process; no such program
  static Result<Process> start(const std::vector<std::string>& words, const ProcessPlace& place = {});
  Process(Process&& other) noexcept : id_(other.id_) { other.id_ = 0; }
  Process& operator=(Process&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Process();

  /// Its exit code, or 128 + the signal that ended it, once it has ended.
  bool has_ended(int& exit);
  void send(int signal) const;

 private:
  explicit Process(pid_t id) : id_(id) {}
  pid_t id_ = 0;
};

struct Answer {
  int exit = 0;
  std::string out, err;
};

/// Runs a program to its end; what it said.
///
/// Errors  those of Process::start()
Result<Answer> ask(const std::vector<std::string>& words);

}  // namespace duo
