// Pairs of pictures of a board: from two folders, or the still moments of two videos.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "duoptic/source.h"

namespace duo::app {

class BoardPictures {
 public:
  /// Two folders pair by the numbers in their files' names; an empty `right` is the same folder, which then has both, told by
  /// "left" and "right" in their names. Two videos give of every third of a second the stillest pair.
  ///
  /// Errors  those of sources; folders without pictures, or whose pictures do not pair
  static Result<BoardPictures> open(const std::filesystem::path& left, const std::filesystem::path& right);

  std::int64_t count() const;
  /// False at the end.
  Result<bool> next(Pair& into, std::string& name);
  std::string warning() const { return video_ ? video_->warning() : ""; }
  bool cut() const { return cut_; }

 private:
  Result<bool> next_still(Pair& into, std::string& name);

  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> files_;
  std::size_t at_ = 0;
  std::unique_ptr<PairSource> video_;
  Pair before_;
  std::int64_t frame_ = 0;
  bool cut_ = false;
};

}  // namespace duo::app
