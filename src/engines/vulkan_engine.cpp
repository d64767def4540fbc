// The Vulkan engine: the whole frame on a device, the same bits; if the device is lost, the CPU goes on.

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <mutex>
#include <utility>

#include "core/check.h"
#include "core/object_pool.h"
#include "engines/engines.h"
#include "engines/keep_windows.h"
#include "engines/vulkan_frames.h"

namespace duo {
namespace {

class VulkanEngine final : public Engine {
 public:
  VulkanEngine(std::unique_ptr<vk::Device> device, int threads) : device_(std::move(device)), threads_(threads) {}

  const char* name() const override { return cpu_ != nullptr ? cpu_->name() : "vulkan"; }
  std::string device() const override { return cpu_ != nullptr ? std::string() : device_name_; }
  int in_flight() const override { return vk::Frames::kInFlight; }
  const std::optional<Rectified>& rectified() const override { return prepared_->geometry; }
  std::string take_event() override { return std::exchange(event_, {}); }

  Result<void> prepare(const Setup& setup) override {
    DUO_TRY_ASSIGN(Prepared checked, prepare_setup(setup));
    auto prepared = std::make_unique<Prepared>(std::move(checked));
    const std::lock_guard lock(observing_);
    unseen_ = false;
    work_.reset();  // first: it speaks of the old setup, and there need not be memory for both
    if (device_ != nullptr) {
      auto work = vk::Frames::make(*device_, *prepared);
      if (work) {
        work_ = std::move(*work);
        cpu_.reset();
      } else {
        give_up(work.error());
      }
    }
    prepared_ = std::move(prepared);
    first_ = count_ = 0;
    slots_ = work_ != nullptr ? work_->slots() : vk::Frames::kInFlight;
    if (work_ == nullptr) return prepare_cpu();
    frames_ = ObjectPool<Frame>(in_flight() + kSpareFrames, [this] { return work_->make_frame(); });
    if (work_->observers() != nullptr) clicked_ = make_frame(*prepared_);
    return {};
  }

  void look_at(std::span<const Window> windows) override { windows_.assign(windows.begin(), windows.end()); }

  void submit(const Pair& pair) override {
    DUO_CHECK(prepared_ != nullptr && count_ < vk::Frames::kInFlight);
    DUO_CHECK(pair.left.pixels.size() == prepared_->setup.size && pair.right.pixels.size() == prepared_->setup.size);
    const int slot = (first_ + count_++) % slots_;
    pairs_[static_cast<std::size_t>(slot)] = &pair;
    windows_of_[static_cast<std::size_t>(slot)] = windows_;
    if (unseen_) go_on_with_cpu(why_unseen_);
    if (work_ == nullptr) return;
    if (const auto started = work_->submit(slot, pair); !started) go_on_with_cpu(started.error());
  }

  std::shared_ptr<const Frame> collect() override {
    DUO_CHECK(count_ > 0);
    const int slot = first_;
    first_ = (first_ + 1) % slots_;
    --count_;
    const Pair& pair = *pairs_[static_cast<std::size_t>(slot)];
    if (work_ != nullptr) {
      const std::shared_ptr<Frame> made = frames_.lend();
      Frame& frame = *made;
      const auto done = work_->collect(slot, frame);
      if (done) {
        frame.sequence = pair.sequence;
        frame.t_ns = pair.left.t_ns;
        frame.skew_ns = pair.right.t_ns - pair.left.t_ns;
        keep_windows(windows_of_[static_cast<std::size_t>(slot)], frame);
        if (work_->observers() != nullptr) frame.observer = &observers_[static_cast<std::size_t>(slot)];
        return made;
      }
      go_on_with_cpu(done.error());
    }
    cpu_->look_at(windows_of_[static_cast<std::size_t>(slot)]);
    cpu_->submit(pair);
    return cpu_->collect();
  }

 private:
  /// Of the frame in one slot.
  class SlotObserver final : public Observer {
   public:
    SlotObserver(VulkanEngine& engine, int slot) : engine_(engine), slot_(slot) {}
    bool observe(const Expectation& expected, Observation& seen) override {
      return engine_.look([&](vk::Observers& observers) { return observers.observe(slot_, expected, seen); }).has_value();
    }
    Result<const Frame*> maps() override {
      Frame& frame = engine_.clicked_;
      DUO_TRY(engine_.look([&](vk::Observers& observers) { return observers.fetch(slot_, frame); }));
      return &frame;
    }

   private:
    VulkanEngine& engine_;
    const int slot_;
  };

  /// In the tracker's thread. What goes wrong is left to the engine's: only that one gives the device up.
  Result<void> look(const auto& with) {
    const std::lock_guard lock(observing_);
    if (work_ == nullptr || unseen_)
      return Error{ErrorCode::kDeviceLost, "look at a frame: its device is lost; take the next frame"};
    auto looked = with(*work_->observers());
    if (!looked) {
      why_unseen_ = looked.error();
      unseen_ = true;
    }
    return looked;
  }

  /// While nobody looks.
  void give_up(const Error& why) {
    event_ = fmt::format("{}; the CPU goes on in its place", why.what);
    work_.reset();
    if (why.code == ErrorCode::kDeviceLost) device_.reset();  // else another setup may be one for it
  }

  Result<void> prepare_cpu() {
    cpu_ = make_simd_engine(threads_);
    Setup setup = prepared_->setup;
    setup.many_at_once = false;  // its frames are made as they are collected
    return cpu_->prepare(setup);
  }

  void go_on_with_cpu(const Error& why) {
    const std::lock_guard lock(observing_);
    give_up(why);
    unseen_ = false;
    DUO_CHECK(prepare_cpu());  // its setup has been checked
  }

  std::unique_ptr<vk::Device> device_;  // null once it was lost
  std::string device_name_ = device_->info().name;
  int threads_;
  std::unique_ptr<Prepared> prepared_ = std::make_unique<Prepared>();
  std::unique_ptr<vk::Frames> work_;  // after what it refers to
  std::unique_ptr<Engine> cpu_;       // once the device was lost, and for setups that are none for it
  ObjectPool<Frame> frames_;
  std::array<const Pair*, vk::Frames::kSlots> pairs_{};  // in flight: count_ of them from first_
  std::vector<Window> windows_;                          // of the next submit
  std::array<std::vector<Window>, vk::Frames::kSlots> windows_of_;
  int first_ = 0, count_ = 0, slots_ = vk::Frames::kInFlight;
  std::string event_;
  std::mutex observing_;              // held while someone looks, and while work_ changes
  std::atomic<bool> unseen_ = false;  // looking failed: why_unseen_ says why, and stays as it is until this is taken back
  Error why_unseen_;
  Frame clicked_;  // what came down for a click
  std::array<SlotObserver, vk::Frames::kSlots> observers_{{{*this, 0}, {*this, 1}, {*this, 2}, {*this, 3}}};
};

}  // namespace

std::unique_ptr<Engine> make_vulkan_engine(std::unique_ptr<vk::Device> device, int threads) {
  return std::make_unique<VulkanEngine>(std::move(device), threads);
}

}  // namespace duo
