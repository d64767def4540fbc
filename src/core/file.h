// Whole files: read with a limit, written atomically.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "duoptic/result.h"

namespace duo {

/// The bytes of a file. `what` names its kind in messages ("rig", "PFM picture").
///
/// Errors  missing, not readable, a folder, more than `limit` bytes
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, std::string_view what);

/// Makes `bytes` the content of `path`. They go to a hidden file beside it, are flushed to the disk, and take the name at the
/// end: after any failure the name holds what it held before and nothing else is left.
///
/// Errors  no such folder, no permission, disk full, the name belongs to something that is not a file
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

/// "cannot write 'path': why; what to do" for an errno.
Error write_error(const std::filesystem::path& path, int error);

/// A file written piece by piece. Until publish() it is a hidden file beside `path`, which the destructor removes.
class PartialFile {
 public:
  /// Errors  those of write_file()
  static Result<PartialFile> open(const std::filesystem::path& path);
  PartialFile(PartialFile&& other) noexcept;
  PartialFile& operator=(PartialFile&&) = delete;
  ~PartialFile();

  /// The hidden file, for a library that writes by name.
  const std::filesystem::path& partial() const { return partial_; }
  Result<void> write(std::string_view bytes);
  /// Flushes it to the disk and gives it its name.
  Result<void> publish();

 private:
  PartialFile(std::filesystem::path path, std::filesystem::path partial);
  std::filesystem::path path_, partial_;
  int fd_ = -1;  // -1: nothing to remove
};

}  // namespace duo
