#include "duoptic/output_set.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <system_error>
#include <utility>

#include "core/file.h"
#include "duoptic/stdout.h"

namespace duo {
namespace fs = std::filesystem;

namespace {

Error cannot_write(const fs::path& path, const std::string& why) {
  const bool exhausted = errno == ENOMEM || errno == EMFILE || errno == ENFILE;
  return {exhausted ? ErrorCode::kExhausted : ErrorCode::kWriteFailed,
          fmt::format("cannot write to {}: {}", path.string(), why)};
}

Error cannot_write(const fs::path& path) { return cannot_write(path, std::strerror(errno)); }

/// Makes the folders that are missing; `made` has those afterwards.
Result<void> make_folders(const fs::path& folder, std::vector<fs::path>& made) {
  fs::path part;
  std::error_code error;
  for (const fs::path& step : folder) {
    part /= step;
    if (step.empty() || fs::is_directory(part, error)) continue;
    if (::mkdir(part.c_str(), 0777) == 0)
      made.push_back(part);
    else if (errno != EEXIST || !fs::is_directory(part, error))  // else another run has just made it
      return cannot_write(part, errno == EEXIST ? "it is not a folder" : std::strerror(errno));
  }
  return {};
}

/// Waits while another run publishes, a moment; false when that takes too long. Not every file system has locks.
bool lock(int folder) {
  constexpr int kTries = 100;
  constexpr timespec kStep{0, 20'000'000};
  for (int i = 0; i < kTries; ++i) {
    if (::flock(folder, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    ::nanosleep(&kStep, nullptr);
  }
  return false;
}

int open_folder(int in, const char* name, int more = 0) {
  return ::openat(in, name, O_RDONLY | O_DIRECTORY | O_CLOEXEC | more);
}

}  // namespace

Result<OutputSet> OutputSet::open(const fs::path& folder) {
  if (is_stdout(folder)) return cannot_write(folder, "these are several files; name a folder");
  OutputSet out;
  out.folder_ = folder;
  DUO_TRY(make_folders(folder, out.made_));
  out.folder_fd_ = open_folder(AT_FDCWD, folder.empty() ? "." : folder.c_str());
  if (out.folder_fd_ < 0) return cannot_write(folder);
  std::string staging = fmt::format("/proc/self/fd/{}/.duoptic-XXXXXX", out.folder_fd_);
  if (::mkdtemp(staging.data()) == nullptr) return cannot_write(folder);
  out.staging_ = fs::path(staging).filename();
  out.staging_fd_ = open_folder(out.folder_fd_, out.staging_.c_str(), O_NOFOLLOW);
  if (out.staging_fd_ < 0) return cannot_write(folder);
  return out;
}

OutputSet::OutputSet(OutputSet&& other) noexcept
    : folder_(std::move(other.folder_)),
      staging_(std::exchange(other.staging_, {})),
      folder_fd_(std::exchange(other.folder_fd_, -1)),
      staging_fd_(std::exchange(other.staging_fd_, -1)),
      made_(std::exchange(other.made_, {})),
      names_(std::move(other.names_)),
      stale_(std::move(other.stale_)) {}

/// Asks for no memory: there may be none.
OutputSet::~OutputSet() {
  for (const std::string& name : names_) ::unlinkat(staging_fd_, name.c_str(), 0);
  for (const std::string& name : stale_) ::unlinkat(staging_fd_, name.c_str(), 0);
  if (staging_fd_ >= 0) ::close(staging_fd_);
  if (!staging_.empty()) ::unlinkat(folder_fd_, staging_.c_str(), AT_REMOVEDIR);
  if (folder_fd_ >= 0) ::close(folder_fd_);
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) ::rmdir(made->c_str());  // only when empty
}

fs::path OutputSet::operator/(const std::string& name) {
  names_.push_back(name);
  return fmt::format("/proc/self/fd/{}/{}", staging_fd_, name);
}

/// Gives one file its name, and an earlier one's place to that; 0 or an errno.
int OutputSet::put(const std::string& name, bool& replaced) const {
  struct stat there {};
  const char* n = name.c_str();
  replaced = ::fstatat(folder_fd_, n, &there, AT_SYMLINK_NOFOLLOW) == 0;
  if (!replaced) return ::renameat(staging_fd_, n, folder_fd_, n) == 0 ? 0 : errno;
  if (!S_ISREG(there.st_mode) && !S_ISLNK(there.st_mode)) return EISDIR;
  if (::renameat2(staging_fd_, n, folder_fd_, n, RENAME_EXCHANGE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // A file system that cannot exchange two names.
  const std::string fresh = name + ".new";
  if (::renameat(staging_fd_, n, staging_fd_, fresh.c_str()) != 0 || ::renameat(folder_fd_, n, staging_fd_, n) != 0)
    return errno;
  if (::renameat(staging_fd_, fresh.c_str(), folder_fd_, n) == 0) return 0;
  const int error = errno;
  take_back(name, true);
  return error;
}

void OutputSet::take_back(const std::string& name, bool replaced) const {
  if (replaced)
    ::renameat(staging_fd_, name.c_str(), folder_fd_, name.c_str());
  else
    ::unlinkat(folder_fd_, name.c_str(), 0);
}

/// Moves an earlier run's file out of the way, where there is one; 0 or an errno.
int OutputSet::take_away(const std::string& name, bool& gone) const {
  struct stat there {};
  const char* n = name.c_str();
  gone = ::fstatat(folder_fd_, n, &there, AT_SYMLINK_NOFOLLOW) == 0 && (S_ISREG(there.st_mode) || S_ISLNK(there.st_mode));
  return !gone || ::renameat(folder_fd_, n, staging_fd_, n) == 0 ? 0 : errno;
}

Result<void> OutputSet::publish(const std::vector<std::string>& kinds) {
  if (!lock(folder_fd_)) return cannot_write(folder_, "another program has locked the folder; try again");
  for (const std::string& kind : kinds)
    if (std::find(names_.begin(), names_.end(), kind) == names_.end()) stale_.push_back(kind);
  std::vector<bool> replaced(names_.size());
  for (std::size_t i = 0; i < names_.size(); ++i) {
    bool earlier = false;
    const int failed = put(names_[i], earlier);
    replaced[i] = earlier;
    if (failed == 0) continue;
    for (std::size_t done = i; done-- > 0;) take_back(names_[done], replaced[done]);
    errno = failed;
    return cannot_write(folder_ / names_[i]);
  }
  for (const std::string& name : stale_) {
    bool gone = false;
    if (take_away(name, gone) == 0) continue;
    const int failed = errno;
    for (const std::string& earlier : stale_) ::renameat(staging_fd_, earlier.c_str(), folder_fd_, earlier.c_str());
    for (std::size_t done = names_.size(); done-- > 0;) take_back(names_[done], replaced[done]);
    errno = failed;
    return cannot_write(folder_ / name);
  }
  ::flock(folder_fd_, LOCK_UN);
  made_.clear();
  return {};
}

std::vector<std::string> OutputSet::paths() const {
  std::vector<std::string> out;
  for (const std::string& name : names_) out.push_back((folder_ / name).string());
  return out;
}

}  // namespace duo
