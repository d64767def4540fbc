// in_background(): a queue before a sink.
#include <memory>
#include <utility>

#include "duoptic/bounded_queue.h"
#include "duoptic/sink.h"
#include "duoptic/worker.h"
#include "sinks/kept_frame.h"

namespace duo {
namespace {

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
