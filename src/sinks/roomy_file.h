// A file that knows before it is written whether it can be.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <utility>

namespace duo {

/// A file with room made ahead of what is written: a full disk is met before a pair, while the index still fits.
class RoomyFile {
 public:
  explicit RoomyFile(int fd) : fd_(fd) {}
  RoomyFile(const RoomyFile&) = delete;
  RoomyFile& operator=(const RoomyFile&) = delete;
  ~RoomyFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  int fd() const { return fd_; }

  /// Makes sure that the first `end` bytes can be written; 0, or the errno that says why not.
  int reserve(std::int64_t end) {
    rlimit limit{};
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && static_cast<rlim_t>(end) > limit.rlim_cur)
      return EFBIG;
    if (end <= reserved_) return 0;
    constexpr std::int64_t kStep = 4 << 20;
    if (const int error = allocate(end + kStep); error == 0) return reserved_ = end + kStep, 0;
    if (const int error = allocate(end); error != 0) return error;
    return reserved_ = end, 0;
  }

  /// Gives back the room that was not used, and flushes to the disk; 0 or an errno.
  int finish() {
    struct stat now {};
    const bool done = ::fstat(fd_, &now) == 0 && ::ftruncate(fd_, now.st_size) == 0 && ::fsync(fd_) == 0;
    const int error = done ? 0 : errno;
    // A failed close() may be the first to tell of a full disk over a network.
    return ::close(std::exchange(fd_, -1)) == 0 || error != 0 ? error : errno;
  }

 private:
  /// Some file systems cannot: then a full disk is met while writing, and the file ends without its index.
  int allocate(std::int64_t end) const {
    while (::fallocate(fd_, FALLOC_FL_KEEP_SIZE, 0, end) != 0)
      if (errno != EINTR) return errno == EOPNOTSUPP || errno == ENOSYS ? 0 : errno;
    return 0;
  }

  int fd_;
  std::int64_t reserved_ = 0;
};

}  // namespace duo
