#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "duoptic/stdout.h"

namespace duo {
namespace {

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
    case EEXIST:
      return "choose another name";
    case ENOMEM:
      return "close other programs";
    case EMFILE:
    case ENFILE:
      return "raise the limit (ulimit -n) or close other programs";
    default:
      return "write elsewhere or change the permissions";
  }
}

/// Twelve letters and digits from the system's random numbers; empty, with errno, when it gives none.
std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz012345";  // 32: five bits each
  unsigned char bytes[12];
  if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes) return {};
  std::string out;
  for (const unsigned char byte : bytes) out += kLetters[byte % kLetters.size()];
  return out;
}

}  // namespace

bool Descriptor::close() {
  const int fd = std::exchange(fd_, -1);
  return fd < 0 || ::close(fd) == 0;
}

bool is_exhausted(int error) { return error == ENOMEM || error == EMFILE || error == ENFILE || error == EAGAIN; }

Error write_error(const std::filesystem::path& path, int error) {
  return {is_exhausted(error) ? ErrorCode::kExhausted : ErrorCode::kWriteFailed,
          fmt::format("cannot write '{}': {}; {}", shown(path).string(), std::strerror(error), advice(error))};
}

namespace {

Error read_error(const std::filesystem::path& path, std::string_view what, ErrorCode code, std::string_view why) {
  return {code, fmt::format("cannot read {} '{}': {}", what, path.string(), why)};
}

Error read_error(const std::filesystem::path& path, std::string_view what, int error) {
  if (error == ENOENT) return read_error(path, what, ErrorCode::kNotFound, "there is no such file; check the path");
  return read_error(path, what, is_exhausted(error) ? ErrorCode::kExhausted : ErrorCode::kBadInput, std::strerror(error));
}

Error too_large(const std::filesystem::path& path, std::string_view what, std::size_t limit) {
  return read_error(path, what, ErrorCode::kBadInput,
                    fmt::format("it has more than {} bytes, no {} is that large", limit, what));
}

}  // namespace

Result<Descriptor> open_file(const std::filesystem::path& path, std::size_t limit, std::string_view what) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe would wait for its writer
  struct stat there {};
  if (!file.is_open() || ::fstat(file.get(), &there) != 0) return read_error(path, what, errno);
  if (S_ISDIR(there.st_mode)) return read_error(path, what, EISDIR);
  if (!S_ISREG(there.st_mode)) return read_error(path, what, ErrorCode::kBadInput, "it is a device or pipe; give a file");
  if (static_cast<std::uintmax_t>(there.st_size) > limit) return too_large(path, what, limit);
  return file;
}

Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, std::string_view what) {
  DUO_TRY_ASSIGN(const Descriptor file, open_file(path, limit, what));
  std::string bytes;
  constexpr std::size_t kBlock = 1 << 16;
  for (;;) {
    const std::size_t had = bytes.size();
    bytes.resize(had + kBlock);
    const ssize_t n = ::read(file.get(), bytes.data() + had, kBlock);
    if (n < 0 && errno != EINTR) return read_error(path, what, errno);
    bytes.resize(had + static_cast<std::size_t>(n > 0 ? n : 0));
    if (bytes.size() > limit) return too_large(path, what, limit);
    if (n == 0) return bytes;
  }
}

std::filesystem::path shown(const std::filesystem::path& path) {
  constexpr std::string_view kOpen = "/proc/self/fd/", kStaging = ".duoptic-";
  std::error_code error;
  if (!path.native().starts_with(kOpen)) return path;
  const auto folder = std::filesystem::read_symlink(path.parent_path(), error);
  if (error) return path.filename();
  return (folder.filename().native().starts_with(kStaging) ? folder.parent_path() : folder) / path.filename();
}

std::filesystem::path path_in(const Descriptor& folder, const std::string& name) {
  return fmt::format("/proc/self/fd/{}/{}", folder.get(), name);
}

bool is_stdout(const std::filesystem::path& path) {
  return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

namespace {

/// What a file holds, from its first byte on, to stdout after all that was printed there.
Result<void> pour_out(int file) {
  std::string block(1 << 16, '\0');
  if (std::fflush(stdout) != 0 || ::lseek(file, 0, SEEK_SET) != 0) return write_error("stdout", errno);
  for (;;) {
    const ssize_t n = ::read(file, block.data(), block.size());
    if (n == 0) return {};
    if (n < 0 || !write_all(STDOUT_FILENO, std::string_view(block).substr(0, static_cast<std::size_t>(n))))
      return write_error("stdout", errno);
  }
}

}  // namespace

PartialFile::PartialFile(PartialFile&& other) noexcept
    : path_(std::move(other.path_)),
      folder_(std::move(other.folder_)),
      file_(std::move(other.file_)),
      hidden_(std::exchange(other.hidden_, {})),
      device_(other.device_),
      inode_(other.inode_) {}

PartialFile::~PartialFile() {
  if (!hidden_.empty() && is_ours()) ::unlinkat(folder_.get(), hidden_.c_str(), 0);
}

/// Whether the hidden name still means our file.
bool PartialFile::is_ours() const {
  struct stat there {};
  return ::fstatat(folder_.get(), hidden_.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 && there.st_dev == device_ &&
         there.st_ino == inode_;
}

Result<PartialFile> PartialFile::open(const std::filesystem::path& path) {
  PartialFile file(path);
  DUO_TRY(file.create());
  return file;
}

Result<void> PartialFile::create() {
  if (is_stdout(path_)) {  // a file without a name, for libraries that go back in it
    file_ = Descriptor(::memfd_create("stdout", MFD_CLOEXEC));
    if (!file_.is_open()) return write_error(path_, errno);
    return {};
  }
  const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
  folder_ = Descriptor(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!folder_.is_open()) return write_error(path_, errno);
  struct stat there {};
  const bool is_folder = !path_.has_filename();
  if (is_folder || (::fstatat(folder_.get(), path_.filename().c_str(), &there, 0) == 0 && !S_ISREG(there.st_mode)))
    return Error{ErrorCode::kWriteFailed,
                 fmt::format("cannot write '{}': it is a folder or device; give the name of a file", shown(path_).string())};
  const std::string letters = random_letters();
  if (letters.empty()) return write_error(path_, errno);
  const std::string hidden = fmt::format(".{}.{}.partial", path_.filename().string(), letters);
  file_ = Descriptor(::openat(folder_.get(), hidden.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!file_.is_open() || ::fstat(file_.get(), &there) != 0) return write_error(path_, errno);
  hidden_ = hidden;
  device_ = there.st_dev;
  inode_ = there.st_ino;
  return {};
}

Result<void> PartialFile::write(std::string_view bytes) {
  if (!write_all(file_.get(), bytes)) return write_error(path_, errno);
  return {};
}

/// 0 or an errno.
int PartialFile::rename(Earlier earlier) {
  const std::string name = path_.filename();
  if (!is_ours()) return ENOENT;
  if (earlier == Earlier::kKeep) {
    if (::renameat2(folder_.get(), hidden_.c_str(), folder_.get(), name.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    // A file system that cannot: an empty file keeps the name for ours.
    if (!Descriptor(::openat(folder_.get(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)).is_open())
      return errno;
  }
  return ::renameat(folder_.get(), hidden_.c_str(), folder_.get(), name.c_str()) == 0 ? 0 : errno;
}

Result<void> PartialFile::take_name(Earlier earlier) {
  if (hidden_.empty()) return {};
  if (const int error = rename(earlier); error != 0) return write_error(path_, error);
  hidden_.clear();
  return {};
}

Result<void> PartialFile::publish() {
  if (is_stdout(path_)) return pour_out(file_.get());
  // A failed close() may be the first to tell of a full disk over a network.
  if (::fsync(file_.get()) != 0 || !file_.close()) return write_error(path_, errno);
  return take_name(Earlier::kReplace);
}

Result<void> write_file(const std::filesystem::path& path, std::string_view bytes) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  DUO_TRY(file.write(bytes));
  return file.publish();
}

}  // namespace duo
