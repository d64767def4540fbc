// in_background(): a queue before a sink.
#include <memory>
#include <utility>
#include <vector>

#include "duoptic/bounded_queue.h"
#include "duoptic/sink.h"
#include "duoptic/worker.h"

namespace duo {
namespace {

/// A TrackedFrame that waits. Without pictures it holds none, so that the engine has its frames back.
struct KeptFrame {
  TrackedFrame frame;
  std::vector<Person> people;
  Picture left;  // capture time and number alone
  Frame light;

  void keep(const TrackedFrame& from, bool pictures) {
    frame = from;
    people.assign(from.people.begin(), from.people.end());
    if (pictures) return;
    left.t_ns = from.left->t_ns;
    left.sequence = from.left->sequence;
    light.sequence = from.frame->sequence;
    light.t_ns = from.frame->t_ns;
    light.skew_ns = from.frame->skew_ns;
    frame.left = nullptr;
    frame.frame = nullptr;
  }
  /// As long as this is not moved.
  TrackedFrame view() const {
    TrackedFrame out = frame;
    out.people = people;
    if (out.left == nullptr) out.left = {std::shared_ptr<const Picture>(), &left};
    if (out.frame == nullptr) out.frame = {std::shared_ptr<const Frame>(), &light};
    return out;
  }
};

class InBackground final : public Sink {
 public:
  explicit InBackground(std::unique_ptr<Sink> sink)
      : sink_(std::move(sink)), queue_(sink_->wants_pictures() ? 4 : 60, WhenFull::kDropOldest) {}
  ~InBackground() override { queue_.close(); }

  Result<void> start() {
    DUO_TRY_ASSIGN(writer_, Worker::start(
                                "write a frame", [this](const std::stop_token&) { return write_all(); },
                                [this](const Result<void>&) { queue_.close(); }));
    return {};
  }

  Result<void> write(const TrackedFrame& frame) override {
    kept_.keep(frame, sink_->wants_pictures());
    return queue_.put(kept_) ? Result<void>() : writer_.join();
  }
  std::int64_t dropped() const override { return queue_.dropped(); }
  /// Waits for the frame that is being written and those behind it.
  Result<void> finish() override {
    queue_.close();
    DUO_TRY(writer_.join());
    return sink_->finish();
  }

 private:
  Result<void> write_all() {
    KeptFrame taken;
    while (true) {
      DUO_TRY_ASSIGN(const Taken what, queue_.take(taken));
      if (what == Taken::kClosed) return {};
      DUO_TRY(sink_->write(taken.view()));
      taken.frame = {};  // back to who made it
    }
  }

  std::unique_ptr<Sink> sink_;
  BoundedQueue<KeptFrame> queue_;
  KeptFrame kept_;  // on its way into the queue
  Worker writer_;   // last: it uses all of the above
};

}  // namespace

Result<std::unique_ptr<Sink>> in_background(std::unique_ptr<Sink> sink) {
  auto background = std::make_unique<InBackground>(std::move(sink));
  DUO_TRY(background->start());
  return std::unique_ptr<Sink>(std::move(background));
}

}  // namespace duo
