// The search for cameras in a thread of its own: a device that does not answer must not hold a window up.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "duoptic/cameras.h"
#include "duoptic/worker.h"

namespace [[gnu::visibility("default")]] duo {

/// Searches while it lives, every two seconds: cameras are plugged in and out.
class CameraSearch {
 public:
  using Found = Result<std::vector<CameraInfo>>;

  /// `on_news` is called in the search's thread after each search.
  explicit CameraSearch(void (*on_news)());
  ~CameraSearch();
  CameraSearch(const CameraSearch&) = delete;
  CameraSearch& operator=(const CameraSearch&) = delete;

  /// What the last search found; null before the first has ended, for which it waits `patience`.
  std::shared_ptr<const Found> found(std::chrono::milliseconds patience = {}) const;

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable_any news;
    std::shared_ptr<const Found> found;
  };

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();  // outlives this when a device never answers
  Worker worker_;
};

}  // namespace duo
