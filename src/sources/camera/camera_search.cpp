#include "duoptic/camera_search.h"

namespace duo {
namespace {

constexpr std::chrono::seconds kSearchAgain(2), kPatience(1);

}  // namespace

CameraSearch::CameraSearch(void (*on_news)()) {
  auto started = Worker::start("look for cameras", [shared = shared_, on_news](const std::stop_token& stop) -> Result<void> {
    while (!stop.stop_requested()) {
      auto found = std::make_shared<const Found>(find_cameras());
      std::unique_lock lock(shared->mutex);
      shared->found = std::move(found);
      shared->news.notify_all();
      if (stop.stop_requested()) break;
      lock.unlock();
      on_news();
      lock.lock();
      shared->news.wait_for(lock, stop, kSearchAgain, [] { return false; });
    }
    return {};
  });
  if (started)
    worker_ = std::move(*started);
  else
    shared_->found = std::make_shared<const Found>(started.error());
}

CameraSearch::~CameraSearch() {
  if (!worker_.started()) return;
  worker_.ask_to_stop();
  if (!worker_.ends_within(kPatience)) worker_.detach();
}

std::shared_ptr<const CameraSearch::Found> CameraSearch::found(std::chrono::milliseconds patience) const {
  std::unique_lock lock(shared_->mutex);
  shared_->news.wait_for(lock, patience, [this] { return shared_->found != nullptr; });
  return shared_->found;
}

}  // namespace duo
