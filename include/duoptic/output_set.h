// The files of one frame: they appear under their names together, or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// Files are written into a hidden folder inside `folder` and take their names in publish(); what was not published is removed
/// at the end, with the folders that were made for it. Both folders are looked up once: what others put in their place later
/// is not touched.
class OutputSet {
 public:
  /// Errors  the folder cannot be made or written to
  static Result<OutputSet> open(const std::filesystem::path& folder);
  OutputSet(OutputSet&&) noexcept;
  OutputSet& operator=(OutputSet&&) = delete;
  ~OutputSet();

  /// Where to write the file that will be called `name`.
  std::filesystem::path operator/(const std::string& name);

  /// Gives all files their names; files of earlier runs are replaced, all or none, and of those that `kinds` names the ones
  /// that this set lacks are removed: an earlier run's would not fit the others. Of two that publish into one folder the
  /// later one wins whole, where the file system has locks.
  ///
  /// Errors  a name is taken by a folder, or the like; then all names hold what they held before
  Result<void> publish(const std::vector<std::string>& kinds = {});

  std::vector<std::string> paths() const;

 private:
  OutputSet() = default;
  int put(const std::string& name, bool& replaced) const;
  int take_away(const std::string& name, bool& gone) const;
  void take_back(const std::string& name, bool replaced) const;

  std::filesystem::path folder_;
  std::string staging_;  // its name in the folder; empty: none
  int folder_fd_ = -1, staging_fd_ = -1;
  std::vector<std::filesystem::path> made_;  // folders that were not there before, outermost first
  std::vector<std::string> names_, stale_;
};

}  // namespace duo
