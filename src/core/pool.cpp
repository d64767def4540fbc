#include "core/pool.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <exception>

#include "core/check.h"
#include "core/clock.h"

namespace duo {
namespace {

/// To wake a thread that sleeps takes 5 to 50 us, as long as a layer of a network takes. So a thread spins this long before it
/// sleeps, and yields meanwhile: who has work gets the core.
constexpr std::int64_t kSpin_ns = 30'000;
/// A thread that runs together with others pauses this often for them, 2 to 10 us, then yields this often, and then sleeps.
constexpr int kPauses = 200, kYields = 200;

template <class Ready>
void spin_until(Ready ready) {
  for (const std::int64_t end_ns = wall_ns() + kSpin_ns; !ready() && wall_ns() < end_ns;) std::this_thread::yield();
}

/// What the calling thread is a member of.
struct Membership {
  const Pool* pool = nullptr;
  int part = 0;
  int arrived = 0;  // as many as have arrived when all members have come to this thread's last meeting
};
thread_local Membership membership;

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

std::pair<int, int> Pool::Job::items(int part, int parts) const {
  const int blocks = (count + grain - 1) / grain;
  const auto bound = [&](int p) { return std::min(count, static_cast<int>(std::int64_t{blocks} * p / parts) * grain); };
  return {bound(part), bound(part + 1)};
}

void Pool::run(int count, int grain, Call call, void* context) {
  if (count <= 0) return;
  if (workers_.empty()) return call(context, 0, count, 0);
  const Job job{count, grain, call, context};
  if (membership.pool == this) {
    const auto [begin, end] = job.items(membership.part, parts_);
    if (begin < end) call(context, begin, end, membership.part);
    return;
  }
  const std::int64_t begin_ns = wall_ns();
  const bool alone = in_use_ == 1 || count <= grain;
  {
    const std::lock_guard lock(mutex_);
    job_ = job;
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

Pool::Member::Member(Pool& pool, int part) { membership = {&pool, part, 0}; }
Pool::Member::~Member() { membership = {}; }

void Pool::meet() {
  if (membership.pool != this) return;
  const int all = membership.arrived += parts_;
  int arrived = arrived_.fetch_add(1, std::memory_order_acq_rel) + 1;
  if (arrived == all) return arrived_.notify_all();
  for (int looks = 0; arrived < all; arrived = arrived_.load(std::memory_order_acquire), ++looks)
    if (looks < kPauses)
      hwy::Pause();
    else if (looks < kPauses + kYields)
      std::this_thread::yield();
    else
      arrived_.wait(arrived, std::memory_order_acquire);
}

void Pool::run_part(int part) {
  const auto [begin, end] = job_.items(part, parts_);
  if (begin < end) compute(begin, end, part);
}

void Pool::compute(int begin, int end, int part) {
  const std::int64_t begin_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  job_.call(job_.context, begin, end, part);
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
