#include "core/pool.h"

#include <algorithm>

#include "core/check.h"

namespace duo {

Pool::Pool(int threads) {
  DUO_CHECK(threads >= 1);
  workers_.reserve(static_cast<std::size_t>(threads - 1));
  for (int part = 1; part < threads; ++part) workers_.emplace_back([this, part] { work(part); });
}

Pool::~Pool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
}

void Pool::run(int count, int grain, Call call, void* context) {
  if (count <= 0) return;
  if (workers_.empty() || count <= grain) return call(context, 0, count, 0);
  {
    const std::lock_guard lock(mutex_);
    count_ = count;
    grain_ = grain;
    call_ = call;
    context_ = context;
    busy_ = static_cast<int>(workers_.size());
    ++round_;
  }
  start_.notify_all();
  run_part(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void Pool::run_part(int part) const {
  const int blocks = (count_ + grain_ - 1) / grain_;
  const auto bound = [&](int p) { return std::min(count_, static_cast<int>(std::int64_t{blocks} * p / threads()) * grain_); };
  const int begin = bound(part), end = bound(part + 1);
  if (begin < end) call_(context_, begin, end, part);
}

void Pool::work(int part) {
  std::uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    start_.wait(lock, [&] { return stop_ || round_ != seen; });
    if (stop_) return;
    seen = round_;
    lock.unlock();
    run_part(part);
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

}  // namespace duo
