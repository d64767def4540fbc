#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace duo {
namespace {

/// An open file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

const char* advice(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return "make the folder first";
    case ENOSPC:
    case EDQUOT:
      return "free some space or write elsewhere";
    case EFBIG:
      return "the file is larger than this system or its limits allow";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "write elsewhere or change the permissions";
  }
}

}  // namespace

Error write_error(const std::filesystem::path& path, int error) {
  return {ErrorCode::kWriteFailed,
          fmt::format("cannot write '{}': {}; {}", path.string(), std::strerror(error), advice(error))};
}

Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, std::string_view what) {
  const auto error = [&](ErrorCode code, std::string_view why) {
    return Error{code, fmt::format("cannot read {} '{}': {}", what, path.string(), why)};
  };
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0)
    return error(errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kBadInput,
                 errno == ENOENT ? "there is no such file; check the path" : std::strerror(errno));
  std::string bytes;
  constexpr std::size_t kBlock = 1 << 16;
  for (;;) {
    const std::size_t had = bytes.size();
    bytes.resize(had + kBlock);
    const ssize_t n = ::read(file.get(), bytes.data() + had, kBlock);
    if (n < 0 && errno != EINTR) return error(ErrorCode::kBadInput, std::strerror(errno));
    bytes.resize(had + static_cast<std::size_t>(n > 0 ? n : 0));
    if (bytes.size() > limit)
      return error(ErrorCode::kBadInput, fmt::format("it has more than {} bytes, no {} is that large", limit, what));
    if (n == 0) return bytes;
  }
}

// The process id keeps two runs that write the same name apart.
PartialFile::PartialFile(std::filesystem::path path, std::filesystem::path partial)
    : path_(std::move(path)),
      partial_(std::move(partial)),
      fd_(::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666)) {}

PartialFile::PartialFile(PartialFile&& other) noexcept
    : path_(std::move(other.path_)), partial_(std::move(other.partial_)), fd_(std::exchange(other.fd_, -1)) {}

PartialFile::~PartialFile() {
  if (fd_ < 0) return;
  ::close(fd_);
  ::unlink(partial_.c_str());
}

Result<PartialFile> PartialFile::open(const std::filesystem::path& path) {
  struct stat there {};
  if (::stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode))
    return Error{ErrorCode::kWriteFailed,
                 fmt::format("cannot write '{}': it is a folder or device; give the name of a file", path.string())};
  PartialFile file(path, path.parent_path() / fmt::format(".{}.{}.partial", path.filename().string(), ::getpid()));
  if (file.fd_ < 0) return write_error(path, errno);
  return file;
}

Result<void> PartialFile::write(std::string_view bytes) {
  if (!write_all(fd_, bytes)) return write_error(path_, errno);
  return {};
}

Result<void> PartialFile::publish() {
  const bool flushed = ::fsync(fd_) == 0;
  // A failed close() may be the first to tell of a full disk over a network.
  if (flushed && ::close(std::exchange(fd_, -1)) == 0 && ::rename(partial_.c_str(), path_.c_str()) == 0) return {};
  const Error error = write_error(path_, errno);
  if (fd_ < 0) ::unlink(partial_.c_str());
  return error;
}

Result<void> write_file(const std::filesystem::path& path, std::string_view bytes) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  DUO_TRY(file.write(bytes));
  return file.publish();
}

}  // namespace duo
