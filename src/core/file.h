// Whole files: read with a limit, written atomically.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "duoptic/result.h"

namespace duo {

/// An open file descriptor, closed with this object.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { static_cast<void>(close()); }
  bool is_open() const { return fd_ >= 0; }
  int get() const { return fd_; }
  /// False, with errno, when the system refuses.
  bool close();

 private:
  int fd_;
};

/// Opens a file to be read, without waiting for anything. `what` names its kind in messages ("rig", "PFM picture").
///
/// Errors  missing, not readable, no regular file, more than `limit` bytes
Result<Descriptor> open_file(const std::filesystem::path& path, std::size_t limit, std::string_view what);

/// The bytes of a file; its size is looked at before.
///
/// Errors  those of open_file(); it grows beyond `limit` meanwhile
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, std::string_view what);

/// Makes `bytes` the content of `path`. They go to a hidden file beside it, are flushed to the disk, and take the name at the
/// end: after any failure the name holds what it held before and nothing else is left.
///
/// Errors  no such folder, no permission, disk full, the name belongs to something that is not a file
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

/// "cannot write 'path': why; what to do" for an errno.
Error write_error(const std::filesystem::path& path, int error);

/// True where the machine has no more of it, be it memory, open files or threads: nothing is wrong with input or output.
bool is_exhausted(int error);

/// A path into an open folder, whatever the folder's own name comes to mean.
std::filesystem::path path_in(const Descriptor& folder, const std::string& name);

/// Such a path, or any other, as messages name it: in the folder where it will appear.
std::filesystem::path shown(const std::filesystem::path& path);

/// A file written piece by piece: a hidden one beside `path`, of a name that nobody can guess, until it takes its own. Both
/// names are looked up in the folder as it was opened. Gone with this object if it never took its name; a file of another's
/// is neither written nor removed.
class PartialFile {
 public:
  /// Errors  those of write_file()
  static Result<PartialFile> open(const std::filesystem::path& path);
  PartialFile(PartialFile&& other) noexcept;
  PartialFile& operator=(PartialFile&&) = delete;
  ~PartialFile();

  /// Open for reading and writing, for a library that does both itself.
  int fd() const { return file_.get(); }
  Result<void> write(std::string_view bytes);

  enum class Earlier : std::uint8_t { kReplace, kKeep };
  /// Gives it its name; it stays open.
  ///
  /// Errors  with kKeep: something has the name
  Result<void> take_name(Earlier earlier);
  /// Flushes it to the disk, closes it, and gives it its name unless it has it.
  Result<void> publish();

 private:
  explicit PartialFile(std::filesystem::path path) : path_(std::move(path)) {}
  Result<void> create();
  bool is_ours() const;
  int rename(Earlier earlier);

  std::filesystem::path path_;
  Descriptor folder_, file_;
  std::string hidden_;  // its name; empty: it has taken its own, or there is none
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace duo
