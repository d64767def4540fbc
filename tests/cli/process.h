// A program in a process of its own, which is watched, disturbed and ended.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace duo::test {

/// The tool with these words, split at spaces, in `folder`; what it says goes to stdout.txt and stderr.txt there.
class ToolProcess {
 public:
  struct Surroundings {
    std::map<std::string, std::string> environment = {};
    rlim_t most_file_bytes = RLIM_INFINITY;
  };

  ToolProcess(const std::filesystem::path& folder, const std::string& arguments, const Surroundings& around) {
    std::vector<std::string> words = {DUO_TOOL};
    std::istringstream text(arguments);
    for (std::string word; text >> word;) words.push_back(word);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::vector<std::string> variables;
    for (char** v = environ; *v != nullptr; ++v) variables.emplace_back(*v);
    for (const auto& [name, value] : around.environment) variables.push_back(name + "=" + value);
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    environment.push_back(nullptr);
    const std::string out = folder / "stdout.txt", err = folder / "stderr.txt";
    process_ = fork();
    if (process_ != 0) return;
    const rlimit most{around.most_file_bytes, around.most_file_bytes};
    const bool ready = chdir(folder.c_str()) == 0 && dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), 1) == 1 &&
                       dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), 2) == 2 &&
                       (around.most_file_bytes == RLIM_INFINITY || setrlimit(RLIMIT_FSIZE, &most) == 0);
    if (ready) execve(argv[0], argv.data(), environment.data());
    _exit(126);
  }
  ToolProcess(const ToolProcess&) = delete;
  ToolProcess& operator=(const ToolProcess&) = delete;
  ~ToolProcess() {
    if (process_ > 0) send(SIGKILL), static_cast<void>(end());
  }

  void send(int signal) const { kill(process_, signal); }
  pid_t id() const { return process_; }

  /// Waits for its end: its exit code, 128 + the signal that ended it, or kHangs, and then it is killed: for five seconds it
  /// has neither computed nor ended, or for a minute not ended.
  static constexpr int kHangs = -1;
  int end() {
    using namespace std::chrono_literals;
    const auto start = std::chrono::steady_clock::now();
    auto moved = start;
    for (long before = -1;; std::this_thread::sleep_for(3ms)) {
      int status = 0;
      rusage used{};
      if (wait4(process_, &status, WNOHANG, &used) == process_) {
        most_memory_mb_ = used.ru_maxrss / 1024;
        cpu_s_ = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                 static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec) * 1e-6;
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      }
      const auto now = std::chrono::steady_clock::now();
      const long ticks = cpu_ticks();
      if (ticks != before) moved = now;
      before = ticks;
      if (now - moved < 5s && now - start < 60s) continue;
      send(SIGKILL);
      waitpid(process_, &status, 0);
      process_ = -1;
      return kHangs;
    }
  }
  /// Of one that has ended.
  long most_memory_mb() const { return most_memory_mb_; }
  double cpu_s() const { return cpu_s_; }

 private:
  /// User and system time in hundredths of a second: fields 14 and 15, counted after the name in parentheses.
  long cpu_ticks() const {
    std::ifstream stat("/proc/" + std::to_string(process_) + "/stat");
    std::string line;
    std::getline(stat, line);
    std::istringstream fields(line.substr(std::min(line.size(), line.rfind(')') + 2)));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    long user = 0, system = 0;
    fields >> user >> system;
    return user + system;
  }

  pid_t process_ = -1;
  long most_memory_mb_ = 0;
  double cpu_s_ = 0;
};

}  // namespace duo::test
