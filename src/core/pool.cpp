#include "core/pool.h"

#include <algorithm>
#include <exception>

#include "core/check.h"
#include "core/clock.h"

namespace duo {
namespace {

/// To wake a thread that sleeps takes 5 to 50 us, as long as a layer of a network takes. So a thread spins this long before it
/// sleeps, and yields meanwhile: who has work gets the core.
constexpr std::int64_t kSpin_ns = 30'000;

template <class Ready>
void spin_until(Ready ready) {
  for (const std::int64_t end_ns = wall_ns() + kSpin_ns; !ready() && wall_ns() < end_ns;) std::this_thread::yield();
}

}  // namespace

Pool::Pool(int threads) : in_use_(threads) {
  DUO_CHECK(threads >= 1);
  workers_.reserve(static_cast<std::size_t>(threads - 1));
  try {
    for (int part = 1; part < threads; ++part) workers_.emplace_back([this, part] { work(part); });
  } catch (const std::exception&) {  // the system allows no more, or has no memory for it: those there are do all
    in_use_ = most();
  }
}

Pool::~Pool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
}

void Pool::use(int threads) {
  DUO_CHECK(threads >= 1 && threads <= most());
  in_use_ = threads;
}

Pool::Effort Pool::take_effort() {
  const Effort out{wall_ns_, cpu_ns_.exchange(0)};
  wall_ns_ = 0;
  return out;
}

void Pool::run(int count, int grain, Call call, void* context) {
  if (count <= 0) return;
  if (workers_.empty()) return call(context, 0, count, 0);
  const std::int64_t begin_ns = wall_ns();
  const bool alone = in_use_ == 1 || count <= grain;
  {
    const std::lock_guard lock(mutex_);
    count_ = count;
    grain_ = grain;
    call_ = call;
    context_ = context;
    parts_ = alone ? 1 : in_use_;
    busy_ = parts_ - 1;
    round_ += !alone;
  }
  if (alone) {
    compute(0, count, 0);
  } else {
    start_.notify_all();
    run_part(0);
    spin_until([this] { return busy_ == 0; });
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
  }
  wall_ns_ += wall_ns() - begin_ns;
}

void Pool::run_part(int part) {
  const int blocks = (count_ + grain_ - 1) / grain_;
  const auto bound = [&](int p) { return std::min(count_, static_cast<int>(std::int64_t{blocks} * p / parts_) * grain_); };
  const int begin = bound(part), end = bound(part + 1);
  if (begin < end) compute(begin, end, part);
}

void Pool::compute(int begin, int end, int part) {
  const std::int64_t begin_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  call_(context_, begin, end, part);
  cpu_ns_ += clock_ns(CLOCK_THREAD_CPUTIME_ID) - begin_ns;
}

void Pool::work(int part) {
  std::uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    lock.unlock();
    spin_until([&] { return round_ != seen; });
    lock.lock();
    start_.wait(lock, [&] { return stop_ || round_ != seen; });
    if (stop_) return;
    seen = round_;
    if (part >= parts_) continue;  // of this round, or woken late for one it had no part in
    lock.unlock();
    run_part(part);
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

}  // namespace duo
