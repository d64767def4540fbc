#include "archive/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "archive/layout.h"
#include "core/file.h"

namespace duo {
namespace {

bool becomes(const std::string& path, int flags, int number) {
  const int file = ::open(path.c_str(), flags, 0666);
  return file >= 0 && ::dup2(file, number) == number && (file == number || ::close(file) == 0);
}

/// In the new process: only what may be called between fork() and exec(). The errno of what failed.
int become(char* const* words, const std::string& folder, const std::string& out, const std::string& err, pid_t parent) {
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || ::getppid() != parent) return ESRCH;
  if (!becomes("/dev/null", O_RDONLY, 0)) return errno;
  if (!out.empty() && !becomes(out, kWrite, 1)) return errno;
  if (!err.empty() && !becomes(err, kWrite, 2)) return errno;
  if (!folder.empty() && ::chdir(folder.c_str()) != 0) return errno;
  ::signal(SIGXFSZ, SIG_DFL);
  ::execvp(words[0], words);
  return errno;
}

}  // namespace

Result<Process> Process::start(const std::vector<std::string>& words, const ProcessPlace& place) {
  const auto failed = [&](int error) {
    return Error{is_exhausted(error) ? ErrorCode::kExhausted : ErrorCode::kUnsupported,
                 fmt::format("cannot start {}: {}", words[0], std::strerror(error))};
  };
  std::vector<std::string> copy = words;
  std::vector<char*> argv;
  for (std::string& word : copy) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string folder = place.folder, out = place.out, err = place.err;
  int tells[2];  // what keeps the program from starting; closed by its start
  if (::pipe2(tells, O_CLOEXEC) != 0) return failed(errno);
  const Descriptor reads(tells[0]);
  Descriptor writes(tells[1]);
  const pid_t parent = ::getpid(), id = ::fork();
  if (id < 0) return failed(errno);
  if (id == 0) {
    const int error = become(argv.data(), folder, out, err, parent);
    static_cast<void>(!::write(writes.get(), &error, sizeof error));
    ::_exit(127);
  }
  Process process(id);
  writes.close();
  int error = 0;
  ssize_t n = 0;
  while ((n = ::read(reads.get(), &error, sizeof error)) < 0 && errno == EINTR) {
  }
  if (n == sizeof error) return failed(error);
  return process;
}

Process::~Process() {
  if (id_ <= 0) return;
  ::kill(id_, SIGKILL);
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
}

bool Process::has_ended(int& exit) {
  int status = 0;
  const pid_t ended = ::waitpid(id_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
  exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  id_ = 0;
  return true;
}

void Process::send(int signal) const {
  if (id_ > 0) ::kill(id_, signal);
}

Result<Answer> ask(const std::vector<std::string>& words) {
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  if (error) return Error{ErrorCode::kWriteFailed, "cannot write temporary files: TMPDIR names no folder"};
  const std::filesystem::path folder = temporary / ("duoptic-" + random_name());
  DUO_TRY(make_folder(folder));
  const std::filesystem::path out = folder / "out", err = folder / "err";
  Answer answer;
  {
    auto process = Process::start(words, {.out = out, .err = err});
    while (process && !process->has_ended(answer.exit)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (process) {
      answer.out = read_file(out, kMostText, "answer").has_value() ? *read_file(out, kMostText, "answer") : "";
      answer.err = read_file(err, kMostText, "answer").has_value() ? *read_file(err, kMostText, "answer") : "";
    }
    std::filesystem::remove_all(folder, error);
    if (!process) return process.error();
  }
  return answer;
}

}  // namespace duo
