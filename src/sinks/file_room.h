// A file that knows before it is written whether it can be.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

namespace duo {

/// Room made in an open file ahead of what is written: a full disk is met before a pair, while the index still fits.
class FileRoom {
 public:
  explicit FileRoom(int fd) : fd_(fd) {}

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

  /// Gives back what was not used; 0 or an errno.
  int give_back() const {
    struct stat now {};
    return ::fstat(fd_, &now) == 0 && ::ftruncate(fd_, now.st_size) == 0 ? 0 : errno;
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
