// The harness in which kernels are held against the reference: on every Vulkan device found, with core and synchronisation
// validation on. A program that includes this fails when there is no device, unless DUOPTIC_NO_VULKAN=1, and when the
// validation layer says anything at all.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/agree.h"
#include "vulkan/recorder.h"

// The validation layer keeps a few kB for each kernel that it has seen; the software driver has its own idea of a race.
extern "C" __attribute__((used)) inline const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation.so\nleak:libvulkan_lvp.so\nleak:libLLVM\n";
}
extern "C" __attribute__((used)) inline const char* __tsan_default_suppressions() {
  return "race:libvulkan_lvp.so\nrace:libVkLayer_khronos_validation.so\n";
}

namespace duo::test {

/// The value, or a failed test that shows the error.
template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().what);
  return std::move(*result);
}
inline void must(const Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().what);
}

/// Whether this run checks every access of the kernels: a hundred times slower, so that tests with many cases leave some out.
inline bool assisted() { return std::getenv("DUOPTIC_GPU_ASSISTED") != nullptr; }

/// Opens every usable device before the first test, and looks at what validation said after the last.
class VulkanEnvironment : public ::testing::Environment {
 public:
  void SetUp() override {
    if (const char* none = std::getenv("DUOPTIC_NO_VULKAN"); none != nullptr && std::strcmp(none, "1") == 0) {
      std::puts("skipped: no Vulkan");
      std::exit(77);  // ctest: skipped
    }
    auto instance = vk::Instance::open(assisted() ? vk::Validation::kGpuAssisted : vk::Validation::kOn);
    ASSERT_TRUE(instance.has_value()) << instance.error().what;
    instance_ = *instance;
    const auto physical = instance_->devices();
    ASSERT_TRUE(physical.has_value()) << physical.error().what;
    // Reports of the sanitizers name a library, as the suppressions below ask, only while it is loaded.
    for (const char* library : {"libVkLayer_khronos_validation.so", "libvulkan_lvp.so"})
      dlopen(library, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
    for (const vk::PhysicalDevice& each : *physical) {
      if (!each.info.lacks.empty()) continue;
      expect_subgroup_size(each.info);
      auto device = vk::Device::make(instance_, each);
      ASSERT_TRUE(device.has_value()) << device.error().what;
      devices_.push_back(std::move(*device));
    }
    ASSERT_FALSE(devices_.empty()) << "no Vulkan device has all that the kernels need";
  }
  void TearDown() override {
    devices_.clear();  // first: validation speaks of leaked objects here
    if (instance_ != nullptr)
      for (const std::string& message : instance_->messages()) ADD_FAILURE() << message;
    instance_.reset();
  }
  const std::vector<std::unique_ptr<vk::Device>>& devices() const { return devices_; }

 private:
  // Mesa's software driver takes the width of its vectors from the environment; each lane has 32 bits.
  static void expect_subgroup_size(const DeviceInfo& info) {
    const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
    if (info.type == "software" && width != nullptr) {
      EXPECT_EQ(info.subgroup_size, std::atoi(width) / 32) << info.name;
    }
  }

  std::shared_ptr<vk::Instance> instance_;
  std::vector<std::unique_ptr<vk::Device>> devices_;
};

inline auto* const kVulkan =
    static_cast<VulkanEnvironment*>(::testing::AddGlobalTestEnvironment(new VulkanEnvironment));  // gtest owns it

/// Calls f(device, " vk on NAME") for each device.
template <class F>
void each_device(F&& f) {
  for (const auto& device : kVulkan->devices()) f(*device, " vk on " + device->info().name);
}

/// A picture on a device, with an odd stride and a margin before and after it that nobody may write.
template <class T>
class OnDevice {
 public:
  OnDevice(const vk::Device& device, Size size, const std::string& name)
      : size_(size),
        plane_{kMargin, size.width + 3},
        elements_(static_cast<std::size_t>(plane_.stride) * size.height + 2 * kMargin),
        memory_(must(vk::Buffer::make(device, name, elements_ * sizeof(T), vk::Memory::kDevice))),
        staging_(must(vk::Buffer::make(device, name + " staging", elements_ * sizeof(T), vk::Memory::kDownload))) {
    std::memset(staging_.mapped().data(), kGuard, staging_.bytes());
  }
  OnDevice(const vk::Device& device, View<const T> pixels, const std::string& name) : OnDevice(device, pixels.size(), name) {
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) staged()[index(y, x)] = pixels.at(y, x);
  }

  vk::BufferView<T> view() const { return {memory_, plane_}; }
  void record_upload(vk::Recorder& recorder) const { recorder.copy(staging_, memory_, memory_.bytes()); }
  void record_download(vk::Recorder& recorder) const { recorder.copy(memory_, staging_, memory_.bytes()); }

  /// What record_download() fetched; fails where anything outside the picture was written.
  Image<T> pixels(const std::string& what) const {
    Image<T> out(size_);
    std::vector<bool> inside(elements_);
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) {
        out.at(y, x) = staged()[index(y, x)];
        inside[index(y, x)] = true;
      }
    T guard;
    std::memset(static_cast<void*>(&guard), kGuard, sizeof(T));
    for (std::size_t i = 0; i < elements_; ++i)
      if (!inside[i] && staged()[i] != guard) {
        ADD_FAILURE() << what << " " << size_.width << "x" << size_.height << ": wrote outside the picture, element " << i;
        break;
      }
    return out;
  }

 private:
  static constexpr int kMargin = 5, kGuard = 0xA5;
  T* staged() const { return reinterpret_cast<T*>(staging_.mapped().data()); }
  std::size_t index(int y, int x) const { return static_cast<std::size_t>(plane_.offset + y * plane_.stride + x); }

  Size size_;
  vk::Plane plane_;
  std::size_t elements_;
  vk::Buffer memory_, staging_;
};

/// Uploads all pictures, runs what `record` records, and downloads them all.
template <class Record, class... Pictures>
void run_with(vk::Recorder& recorder, Record record, const Pictures&... pictures) {
  recorder.begin();
  (pictures.record_upload(recorder), ...);
  record();
  (pictures.record_download(recorder), ...);
  must(recorder.end());
  must(recorder.run());
}

/// The bytes of a colour picture, as a gray one three times as wide.
inline View<std::uint8_t> channels(Image<Rgb8>& color) {
  return {&color.row(0)->r, {3 * color.width(), color.height()}, 3 * color.stride()};
}

/// Holds a kernel with one input and one output of the same size against its reference.
///
/// make_stage(device) -> Result<Stage>; record(stage, recorder, src view, dst view, size)
template <class In, class Out, class Ref, class MakeStage, class Record>
void agree_vk(const std::string& name, Ref ref, MakeStage make_stage, Record record) {
  each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto stage = must(make_stage(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : awkward_sizes())
      for (const Fill how : kFills) {
        Image<In> src(size);
        Image<Out> want(size);
        fill(src.view(), how, rng);
        ref(View<const In>(src), want.view());
        const OnDevice<In> in(device, src, "src");
        const OnDevice<Out> out(device, size, "dst");
        recorder.begin();
        in.record_upload(recorder);
        out.record_upload(recorder);
        record(stage, recorder, in.view(), out.view(), size);
        out.record_download(recorder);
        must(recorder.end());
        must(recorder.run());
        expect_same<Out>(want, out.pixels(name + where), name + where);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

}  // namespace duo::test
