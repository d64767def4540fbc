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
    const std::lock_guard lock(using_);
    failed_ = false;
    work_.reset();  // first: it speaks of the old setup, and there need not be memory for both
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
    first_ = count_ = 0;
    slots_ = work_ != nullptr ? work_->slots() : vk::Frames::kInFlight;
    if (work_ == nullptr) return prepare_cpu();
    frames_ = ObjectPool<Frame>(in_flight() + kSpareFrames, [this] { return work_->make_frame(); });
    return {};
  }

  void look_at(std::span<const Window> windows) override { windows_.assign(windows.begin(), windows.end()); }

  void submit(const Pair& pair) override {
    DUO_CHECK(prepared_ != nullptr && count_ < vk::Frames::kInFlight);
    DUO_CHECK(pair.left.pixels.size() == prepared_->setup.size && pair.right.pixels.size() == prepared_->setup.size);
    const int slot = (first_ + count_++) % slots_;
    pairs_[static_cast<std::size_t>(slot)] = &pair;
    windows_of_[static_cast<std::size_t>(slot)] = windows_;
    if (failed_) go_on_with_cpu(why_failed_);
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
        frame.on_device = work_->on_device() != nullptr ? &on_device_[static_cast<std::size_t>(slot)] : nullptr;
        return made;
      }
      go_on_with_cpu(done.error());
    }
    cpu_->look_at(windows_of_[static_cast<std::size_t>(slot)]);
    cpu_->submit(pair);
    return cpu_->collect();
  }

 private:
  /// The frame in one slot. What goes wrong in the tracker's thread is left to the engine's: only that one gives the device up.
  class Slot final : public vk::FrameOnDevice {
   public:
    Slot(VulkanEngine& engine, int slot) : engine_(engine), slot_(slot) {}
    Result<void> use(const Work& work) override {
      const std::lock_guard lock(engine_.using_);
      if (engine_.work_ == nullptr || engine_.failed_)
        return Error{ErrorCode::kDeviceLost, "use a frame on its device: the device is lost; take the next frame"};
      auto used = work(engine_.work_->on_device(), slot_);
      if (!used) {
        engine_.why_failed_ = used.error();
        engine_.failed_ = true;
      }
      return used;
    }

   private:
    VulkanEngine& engine_;
    const int slot_;
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
    const std::lock_guard lock(using_);
    give_up(why);
    failed_ = false;
    DUO_CHECK(prepare_cpu());  // its setup has been checked
  }

  std::shared_ptr<vk::Device> device_;  // null once it was lost; shared with who uses frames on it
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
  std::mutex using_;                  // held while someone uses a frame on the device, and while work_ changes
  std::atomic<bool> failed_ = false;  // using one failed: why_failed_ says why, and stays as it is until this is taken back
  Error why_failed_;
  std::array<Slot, vk::Frames::kSlots> on_device_{{{*this, 0}, {*this, 1}, {*this, 2}, {*this, 3}}};
};

}  // namespace

std::unique_ptr<Engine> make_vulkan_engine(std::unique_ptr<vk::Device> device, int threads) {
  return std::make_unique<VulkanEngine>(std::move(device), threads);
}

}  // namespace duo
