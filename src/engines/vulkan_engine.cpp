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
#include "vulkan/frame_on_device.h"

namespace duo {
namespace {

class VulkanEngine;

/// What frames that stay on the device share with their engine, and may outlive it with.
struct InUse {
  std::mutex mutex;                // held while someone uses a frame on the device, and while the engine's work changes
  VulkanEngine* engine = nullptr;  // null once it is gone
};

/// A frame of the pool, and what its on_device points to.
struct DeviceFrame : Frame {
  class Handle final : public vk::FrameOnDevice {
   public:
    Result<void> use(const Work& work) override;
    std::shared_ptr<InUse> in_use;
    int slot = 0;
    std::uint64_t number = 0;  // of the frames that the slot has had
  };
  explicit DeviceFrame(Frame made) : Frame(std::move(made)) {}
  Handle handle;
};

class VulkanEngine final : public Engine {
 public:
  VulkanEngine(std::unique_ptr<vk::Device> device, int threads) : device_(std::move(device)), threads_(threads) {
    in_use_->engine = this;
  }
  ~VulkanEngine() override {
    const std::lock_guard lock(in_use_->mutex);
    in_use_->engine = nullptr;
  }

  const char* name() const override { return cpu_ != nullptr ? cpu_->name() : "vulkan"; }
  std::string device() const override { return cpu_ != nullptr ? std::string() : device_name_; }
  int in_flight() const override { return vk::Frames::kInFlight; }
  const std::optional<Rectified>& rectified() const override { return prepared_->geometry; }
  std::string take_event() override { return std::exchange(event_, {}); }

  Result<void> prepare(const Setup& setup) override {
    DUO_TRY_ASSIGN(Prepared checked, prepare_setup(setup));
    auto prepared = std::make_unique<Prepared>(std::move(checked));
    const std::lock_guard lock(in_use_->mutex);
    failed_ = false;
    for (Slot& slot : had_) slot.next();  // frames of the old setup are gone
    work_.reset();                        // first: it speaks of the old setup, and there need not be memory for both
    if (device_ != nullptr) {
      auto work = vk::Frames::make(device_, *prepared);
      if (work) {
        work_ = std::move(*work);
        cpu_.reset();
      } else {
        give_up(work.error());
      }
    }
    prepared_ = std::move(prepared);
    focus_ = {};
    first_ = count_ = 0;
    slots_ = work_ != nullptr ? work_->slots() : vk::Frames::kInFlight;
    if (work_ == nullptr) return prepare_cpu();
    frames_ = ObjectPool<DeviceFrame>(in_flight() + kSpareFrames, [this] { return DeviceFrame(work_->make_frame()); });
    return {};
  }

  void look_at(std::span<const Window> windows) override { windows_.assign(windows.begin(), windows.end()); }
  /// What is recorded are whole pictures. Who looks around people gets all frames from the CPU: what a stream of pictures
  /// settles on must come from the same ones.
  void focus(const Focus& focus) override {
    focus_ = focus;
    if (work_ != nullptr)
      go_on_with_cpu({ErrorCode::kUnsupported, "match parts of pictures on a device: it has no recordings of them"});
  }
  bool can_focus() const override { return !prepared_->match_color; }

  void submit(const Pair& pair) override {
    DUO_CHECK(prepared_ != nullptr && count_ < vk::Frames::kInFlight);
    DUO_CHECK(pair.left.pixels.size() == prepared_->setup.size && pair.right.pixels.size() == prepared_->setup.size);
    const int slot = (first_ + count_++) % slots_;
    pairs_[static_cast<std::size_t>(slot)] = &pair;
    windows_of_[static_cast<std::size_t>(slot)] = windows_;
    focus_of_[static_cast<std::size_t>(slot)] = focus_;
    if (failed_) go_on_with_cpu(why_failed_);
    if (work_ == nullptr) return;
    had_[static_cast<std::size_t>(slot)].next();
    if (const auto started = work_->submit(slot, pair); !started) go_on_with_cpu(started.error());
  }

  std::shared_ptr<const Frame> collect() override {
    DUO_CHECK(count_ > 0);
    const int slot = first_;
    first_ = (first_ + 1) % slots_;
    --count_;
    const Pair& pair = *pairs_[static_cast<std::size_t>(slot)];
    if (work_ != nullptr) {
      const std::shared_ptr<DeviceFrame> made = frames_.lend();
      Frame& frame = *made;
      const auto done = work_->collect(slot, frame);
      if (done) {
        frame.sequence = pair.sequence;
        frame.t_ns = pair.left.t_ns;
        frame.skew_ns = pair.right.t_ns - pair.left.t_ns;
        keep_windows(windows_of_[static_cast<std::size_t>(slot)], frame);
        made->handle.in_use = in_use_;
        made->handle.slot = slot;
        made->handle.number = had_[static_cast<std::size_t>(slot)].number;
        frame.on_device = work_->on_device() != nullptr ? &made->handle : nullptr;
        return made;
      }
      go_on_with_cpu(done.error());
    }
    cpu_->look_at(windows_of_[static_cast<std::size_t>(slot)]);
    cpu_->focus(focus_of_[static_cast<std::size_t>(slot)]);
    cpu_->submit(pair);
    return cpu_->collect();
  }

  /// While the engine's work does not change. What goes wrong in the tracker's thread is left to the engine's: only that one
  /// gives the device up.
  Result<void> use(int slot, std::uint64_t number, const vk::FrameOnDevice::Work& work) {
    if (work_ == nullptr || failed_)
      return Error{ErrorCode::kDeviceLost, "use a frame on its device: the device is lost; take the next frame"};
    Slot& at = had_[static_cast<std::size_t>(slot)];
    const std::lock_guard lock(at.mutex);
    if (at.number != number)
      return Error{ErrorCode::kDeviceLost, "use a frame on its device: a newer one has taken its place; take the newest"};
    auto used = work(work_->on_device(), slot);
    if (!used) {
      why_failed_ = used.error();
      failed_ = true;
    }
    return used;
  }

 private:
  /// The frame whose maps lie in a slot. One that is used there stays until it no longer is.
  struct Slot {
    std::mutex mutex;
    std::uint64_t number = 0;
    void next() {
      const std::lock_guard lock(mutex);
      ++number;
    }
  };

  /// While nobody uses the device.
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
    const std::lock_guard lock(in_use_->mutex);
    give_up(why);
    failed_ = false;
    DUO_CHECK(prepare_cpu());  // its setup has been checked
  }

  std::shared_ptr<vk::Device> device_;  // null once it was lost; shared with who uses frames on it
  std::string device_name_ = device_->info().name;
  int threads_;
  std::unique_ptr<Prepared> prepared_ = std::make_unique<Prepared>();
  std::unique_ptr<vk::Frames> work_;  // after what it refers to
  std::unique_ptr<Engine> cpu_;       // once the device was lost, for setups that are none for it, and around people
  ObjectPool<DeviceFrame> frames_;
  std::array<const Pair*, vk::Frames::kSlots> pairs_{};  // in flight: count_ of them from first_
  std::vector<Window> windows_;                          // of the next submit
  std::array<std::vector<Window>, vk::Frames::kSlots> windows_of_;
  Focus focus_;  // of the next submit
  std::array<Focus, vk::Frames::kSlots> focus_of_;
  int first_ = 0, count_ = 0, slots_ = vk::Frames::kInFlight;
  std::string event_;
  std::shared_ptr<InUse> in_use_ = std::make_shared<InUse>();
  std::array<Slot, vk::Frames::kSlots> had_;
  std::atomic<bool> failed_ = false;  // using one failed: why_failed_ says why, and stays as it is until this is taken back
  Error why_failed_;
};

Result<void> DeviceFrame::Handle::use(const Work& work) {
  const std::lock_guard lock(in_use->mutex);
  if (in_use->engine == nullptr)
    return Error{ErrorCode::kDeviceLost, "use a frame on its device: its engine is gone; take the frames of another"};
  return in_use->engine->use(slot, number, work);
}

}  // namespace

std::unique_ptr<Engine> make_vulkan_engine(std::unique_ptr<vk::Device> device, int threads) {
  return std::make_unique<VulkanEngine>(std::move(device), threads);
}

}  // namespace duo
