// A source of one's own: a program that has pictures already pushes them, and takes frames. Here they are rendered.
//   own_source
#include <duoptic/bounded_queue.h>
#include <duoptic/duoptic.h>
#include <duoptic/synthetic.h>

#include <cstdio>
#include <thread>

/// Pairs that another thread pushes; push() waits while four of them wait to be taken.
class PushedPairs final : public duo::PairSource {
 public:
  explicit PushedPairs(duo::Size size) : size_(size) {}
  bool push(duo::Pair pair) { return queue_.put(pair); }
  void end() { queue_.close(); }

  duo::Size size() const override { return size_; }
  std::int64_t count() const override { return 0; }  // nobody knows
  bool still() const override { return false; }
  std::string warning() const override { return {}; }
  duo::Result<duo::Next> next(duo::Pair& into) override {
    DUO_TRY_ASSIGN(const duo::Taken taken, queue_.take(into));
    return taken == duo::Taken::kClosed ? duo::Next::kEnd : duo::Next::kNew;
  }

 private:
  duo::Size size_;
  duo::BoundedQueue<duo::Pair> queue_{4, duo::WhenFull::kWait};
};

duo::Result<void> print_the_depth() {
  duo::SyntheticSetup room;
  room.size = {160, 120};
  duo::PipelineSetup setup;
  setup.frames.rig = duo::synthetic_rig(room);
  setup.frames.wants.depth = true;

  auto owned = std::make_unique<PushedPairs>(room.size);
  PushedPairs& pushed = *owned;
  DUO_TRY_ASSIGN(auto pipeline, duo::Pipeline::open(std::move(owned), setup));
  const std::jthread camera([&pushed, room]() mutable {
    for (std::uint64_t i = 0; i < 3; ++i) {
      room.t_s = 0.1 * static_cast<double>(i);
      duo::Pair pair = duo::render_synthetic(room, 1).pair;
      pair.sequence = i;
      pair.left.t_ns = pair.right.t_ns = static_cast<duo::TimeNs>(i) * 100'000'000;
      if (!pushed.push(std::move(pair))) return;
    }
    pushed.end();
  });
  while (true) {
    DUO_TRY_ASSIGN(const duo::Next next, pipeline.next());
    if (next != duo::Next::kNew) return {};
    const auto& depth_mm = pipeline.frame()->depth_mm;
    std::printf("%.1f s: %.2f m\n", pipeline.tracked().t_s, depth_mm.at(depth_mm.height() / 2, depth_mm.width() / 2) / 1000.0);
  }
}

int main() {
  const auto done = print_the_depth();
  if (!done) std::fprintf(stderr, "%s\n", done.error().what.c_str());
  return done ? 0 : 1;
}
