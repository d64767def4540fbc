#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "duoptic/devices.h"
#include "stages/median/median_vk.h"
#include "stages/rectify/rectify_vk.h"
#include "tests/agree_vk.h"
#include "vulkan/choose.h"
#include "vulkan/pipeline_cache.h"
#include "vulkan/speed.h"
#include "vulkan/timer.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(Vulkan, ListsDevices) {
  const auto devices = must(vulkan_devices());
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& device : devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_FALSE(device.api_version.empty());
    if (device.lacks.empty()) {
      EXPECT_GT(device.subgroup_size, 0);
    }
  }
}

TEST(Vulkan, SaysWhyThereIsNone) {
  const auto missing = vk::Instance::open(vk::Validation::kOff, "libnot_vulkan.so.1");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_NE(missing.error().what.find("libnot_vulkan.so.1"), std::string::npos) << missing.error().what;
  const auto other = vk::Instance::open(vk::Validation::kOff, "libc.so.6");
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code, ErrorCode::kUnsupported);
}

TEST(Vulkan, RefusesDeviceThatLacksSomething) {
  const auto instance = must(vk::Instance::open(vk::Validation::kOff));
  auto physical = must(instance->devices()).front();
  physical.info.lacks = {"synchronization2", "a compute queue"};
  const auto device = vk::Device::make(instance, physical);
  ASSERT_FALSE(device.has_value());
  EXPECT_NE(device.error().what.find("synchronization2, a compute queue"), std::string::npos) << device.error().what;
}

vk::PhysicalDevice made_up(const char* name, const char* type, std::vector<std::string> lacks = {}) {
  vk::PhysicalDevice out;
  out.info.name = name;
  out.info.type = type;
  out.info.lacks = std::move(lacks);
  return out;
}

TEST(Vulkan, ChoosesTheCardAndNeverASoftwareDriverUnasked) {
  const std::vector<vk::PhysicalDevice> devices = {made_up("llvmpipe", "software"), made_up("Intel UHD", "integrated"),
                                                   made_up("Old Radeon", "discrete", {"shaderInt64"}),
                                                   made_up("GeForce RTX", "discrete"), made_up("GeForce GT", "discrete")};
  const auto name = [&](std::string_view wanted, std::size_t of = 5) {
    const auto chosen = vk::choose_device(std::span(devices).first(of), wanted);
    return chosen ? chosen->info.name : chosen.error().what;
  };
  EXPECT_EQ(name(""), "GeForce RTX") << "the first of the best that lacks nothing";
  EXPECT_EQ(name("", 3), "Intel UHD");
  EXPECT_NE(name("", 1).find("there are 0: llvmpipe (software)"), std::string::npos) << name("", 1);
  EXPECT_EQ(name("0"), "llvmpipe");
  EXPECT_EQ(name("LLVM"), "llvmpipe");
  EXPECT_EQ(name("gt"), "GeForce GT");
  EXPECT_NE(name("radeon").find("lacks shaderInt64"), std::string::npos) << name("radeon");
  EXPECT_NE(name("5").find("none is \"5\""), std::string::npos) << name("5");
  EXPECT_NE(name("1x").find("none is \"1x\""), std::string::npos) << name("1x");
  EXPECT_NE(name("", 0).find("no graphics card"), std::string::npos) << name("", 0);
}

TEST(Vulkan, RefusesBufferOverTheLimit) {
  test::each_device([](vk::Device& device, const std::string&) {
    const auto buffer = vk::Buffer::make(device, "volume", vk::Buffer::kMaxBytes + 1, vk::Memory::kDevice);
    ASSERT_FALSE(buffer.has_value());
    EXPECT_NE(buffer.error().what.find("\"volume\""), std::string::npos) << buffer.error().what;
  });
}

TEST(Vulkan, WaitEndsWithoutTheWork) {
  test::each_device([](vk::Device& device, const std::string&) {
    const auto begin = std::chrono::steady_clock::now();
    const auto waited = device.wait(1'000'000, 20'000'000);  // a ticket that nobody submitted
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    ASSERT_FALSE(waited.has_value());
    EXPECT_EQ(waited.error().code, ErrorCode::kDeviceLost);
  });
}

int allocations = 0;
PFN_vkAllocateMemory allocate_memory = nullptr;

// A frame's buffers are dozens: they share blocks, do not overlap, and give them back.
TEST(Vulkan, BuffersShareMemory) {
  const auto instance = must(vk::Instance::open(vk::Validation::kOn));
  const auto device = must(vk::Device::make(instance, must(instance->devices()).front()));
  allocate_memory = device->calls().vkAllocateMemory;
  device->calls().vkAllocateMemory = [](VkDevice d, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* with,
                                        VkDeviceMemory* out) {
    ++allocations;
    return allocate_memory(d, info, with, out);
  };
  allocations = 0;
  for (int round = 1; round <= 2; ++round) {
    std::vector<vk::Buffer> buffers;
    for (int i = 0; i < 60; ++i) {
      const auto kind = i % 2 == 0 ? vk::Memory::kUpload : vk::Memory::kDevice;
      buffers.push_back(must(vk::Buffer::make(*device, "part", 1000, kind)));
      for (std::byte& b : buffers.back().mapped()) b = static_cast<std::byte>(i);
    }
    for (std::size_t i = 0; i < buffers.size(); i += 2)
      for (const std::byte b : buffers[i].mapped()) ASSERT_EQ(b, static_cast<std::byte>(i));
    EXPECT_EQ(allocations, 2 * round) << "mapped and not, once a round, as all were gone in between";
  }
  EXPECT_TRUE(instance->messages().empty());
}

TEST(Vulkan, MeasuresHowFastADeviceCopies) {
  test::each_device([](vk::Device& device, const std::string&) {
    const DeviceSpeed speed = must(vk::copy_speed(device));
    for (const double gb_s : {speed.copy_gb_s, speed.up_gb_s, speed.down_gb_s}) {
      EXPECT_GT(gb_s, 0.05);
      EXPECT_LT(gb_s, 1e5);
    }
  });
}

TEST(PipelineCache, BringsBackOnlyWhatItWrote) {
  const std::filesystem::path file = ::testing::TempDir() + "duoptic_cache/deeper/pipelines-1";
  std::filesystem::remove(file);
  EXPECT_EQ(vk::read_pipelines(file), "");
  const std::string data("kernels\0and more", 16);
  vk::write_pipelines(file, data);
  EXPECT_EQ(vk::read_pipelines(file), data);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(-3, std::ios::end).put('x');
  EXPECT_EQ(vk::read_pipelines(file), "") << "changed on disk";
  std::filesystem::resize_file(file, 11);
  EXPECT_EQ(vk::read_pipelines(file), "") << "cut";
  vk::write_pipelines("/proc/nowhere/pipelines", data);  // not an error
}

TEST(PipelineCache, WhatIsNoFileOfOursIsLeftAside) {
  namespace fs = std::filesystem;
  const fs::path folder = ::testing::TempDir() + "duoptic_cache_not_ours", file = folder / "pipelines-1";
  fs::remove_all(folder);
  const std::string data = "kernels";
  vk::write_pipelines(file, data);
  ASSERT_EQ(vk::read_pipelines(file), data);
  const auto writable = fs::perms::others_write;
  for (const fs::path& path : {file, folder}) {
    fs::permissions(path, writable, fs::perm_options::add);
    EXPECT_EQ(vk::read_pipelines(file), "") << "anybody could have written " << path;
    fs::permissions(path, writable, fs::perm_options::remove);
  }
  fs::rename(file, folder / "elsewhere");
  fs::create_symlink(folder / "elsewhere", file);
  EXPECT_EQ(vk::read_pipelines(file), "") << "a link";
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(vk::read_pipelines(file), "") << "a pipe, which nobody writes into";
  vk::write_pipelines(file, data);
  EXPECT_TRUE(fs::is_fifo(file));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_EQ(vk::read_pipelines(file), "") << "a folder";
  vk::write_pipelines(file, data);
  EXPECT_TRUE(fs::is_directory(file));
  fs::remove_all(folder);
}

TEST(Recorder, FillsAndOrdersFills) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const Size size{16, 3};
    const auto median = must(vk::Median::make(device));
    const OnDevice<std::uint8_t> a(device, size, "a"), b(device, size, "b");
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin();
    b.record_upload(recorder);
    recorder.fill(*a.view().buffer, 0x07070707);
    median.record(recorder, a.view(), b.view(), size);
    recorder.fill(*a.view().buffer, 0x09090909);
    b.record_download(recorder);
    must(recorder.end());
    must(recorder.run());
    test::expect_same<std::uint8_t>(test::constant<std::uint8_t>(size, 7), b.pixels(where), "median of a fill" + where);
  });
}

// Five medians to and fro between two buffers: each must wait for the one before, in both directions, and so must a second
// run of the same recording with other pixels.
TEST(Recorder, OrdersWhatDepends) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const Size size{67, 21};
    const auto median = must(vk::Median::make(device));
    const OnDevice<std::uint8_t> a(device, size, "a"), b(device, size, "b");
    auto upload = must(vk::Buffer::make(device, "upload", a.view().buffer->bytes(), vk::Memory::kUpload));
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin();
    b.record_upload(recorder);
    recorder.copy(upload, *a.view().buffer, upload.bytes());
    for (int i = 0; i < 5; ++i)
      i % 2 == 0 ? median.record(recorder, a.view(), b.view(), size) : median.record(recorder, b.view(), a.view(), size);
    b.record_download(recorder);
    must(recorder.end());

    std::mt19937 rng(3);
    for (int run = 0; run < 3; ++run) {
      const vk::Plane plane = a.view().plane;
      auto* mapped = reinterpret_cast<std::uint8_t*>(upload.mapped().data());
      const View<std::uint8_t> staged(mapped + plane.offset, size, plane.stride);
      test::fill(staged, test::Fill::kRandom, rng);
      Image<std::uint8_t> want(size), next(size);
      for (int i = 0; i < 5; ++i) {
        ref::median3x3(i == 0 ? View<const std::uint8_t>(staged) : want.view(), next);
        want.swap(next);
      }
      must(recorder.run());
      test::expect_same<std::uint8_t>(want, b.pixels(where), "5 medians" + where);
    }
  });
}

// What a kernel reads may not be overwritten before it has been read; validation sees it if it may.
TEST(Recorder, KeepsInputsUntilTheyAreRead) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const Size size{67, 21};
    const auto before = test::constant<std::uint8_t>(size, 3), after = test::constant<std::uint8_t>(size, 200);
    const auto median = must(vk::Median::make(device));
    const OnDevice<std::uint8_t> a(device, before, "a"), b(device, size, "b"), next(device, after, "next");
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin();
    for (const auto* picture : {&a, &b, &next}) picture->record_upload(recorder);
    median.record(recorder, a.view(), b.view(), size);
    recorder.copy(*next.view().buffer, *a.view().buffer, a.view().buffer->bytes());
    a.record_download(recorder);
    b.record_download(recorder);
    must(recorder.end());
    must(recorder.run());
    test::expect_same<std::uint8_t>(before, b.pixels(where), "median" + where);
    test::expect_same<std::uint8_t>(after, a.pixels(where), "copy" + where);
  });
}

TEST(Recorder, MakesMoreSetsThanOnePoolHolds) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const Size size{5, 4};
    const auto src = test::constant<std::uint8_t>(size, 9);
    const auto median = must(vk::Median::make(device));
    const OnDevice<std::uint8_t> in(device, src, "in");
    std::vector<OnDevice<std::uint8_t>> outs;
    for (int i = 0; i < 70; ++i) outs.emplace_back(device, size, "out");
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin();
    in.record_upload(recorder);
    for (const auto& out : outs) {
      out.record_upload(recorder);
      median.record(recorder, in.view(), out.view(), size);
      out.record_download(recorder);
    }
    must(recorder.end());
    must(recorder.run());
    for (const auto& out : outs) test::expect_same<std::uint8_t>(src, out.pixels(where), "median" + where);
  });
}

TEST(Recorder, RefusesMoreWorkgroupsThanEveryDeviceTakes) {
  test::each_device([](vk::Device& device, const std::string&) {
    const Size size{1, 65536 * vk::kGroupHeight};
    const auto median = must(vk::Median::make(device));
    const OnDevice<std::uint8_t> a(device, size, "a"), b(device, size, "b");
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin();
    median.record(recorder, a.view(), b.view(), size);
    const auto ended = recorder.end();
    ASSERT_FALSE(ended.has_value());
    EXPECT_EQ(ended.error().code, ErrorCode::kUnsupported);
  });
}

TEST(Timer, TimesEachPart) {
  test::each_device([](vk::Device& device, const std::string&) {
    const Size size{320, 240};
    const auto median = must(vk::Median::make(device));
    const OnDevice<std::uint8_t> a(device, test::constant<std::uint8_t>(size, 1), "a"), b(device, size, "b");
    auto timer = must(vk::Timer::make(device, 2));
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin(&timer);
    a.record_upload(recorder);
    recorder.stage("upload");
    median.record(recorder, a.view(), b.view(), size);
    recorder.stage("median");
    must(recorder.end());
    must(recorder.run());
    const auto times = must(timer.read());
    ASSERT_EQ(times.size(), 2u);
    EXPECT_STREQ(times[0].stage, "upload");
    EXPECT_STREQ(times[1].stage, "median");
    if (device.tick_ns() != 0) {
      EXPECT_GT(times[1].ns, 0);
    }
    EXPECT_LT(times[1].ns, 60e9);
  });
}

// Validation that never speaks would prove nothing: here it must. Further instances, so that the tests' own stays silent.
std::vector<std::string> messages_of(void (*mistake)(const vk::Device& device, VkCommandBuffer commands, VkBuffer buffer)) {
  const auto instance = must(vk::Instance::open(vk::Validation::kOn));
  const auto device = must(vk::Device::make(instance, must(instance->devices()).front()));
  const auto buffer = must(vk::Buffer::make(*device, "contested", 64, vk::Memory::kDevice));
  auto recorder = must(vk::Recorder::make(*device));
  recorder.begin();
  mistake(*device, recorder.commands(), buffer.handle());
  (void)recorder.end();
  return instance->messages();
}

TEST(Validation, HearsTheMissingBarrier) {
  const auto messages = messages_of([](const vk::Device& device, VkCommandBuffer commands, VkBuffer buffer) {
    device.fn().vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, 1);
    device.fn().vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, 2);
  });
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos) << messages[0];
}

TEST(Validation, HearsTheStrayRead) {
  const auto instance = must(vk::Instance::open(vk::Validation::kGpuAssisted));
  const auto device = must(vk::Device::make(instance, must(instance->devices()).front()));
  const auto rectify = must(vk::Rectify::make(*device));
  const Size size{4, 4};
  Image<std::uint32_t> corner(size);
  corner.at(1, 1) = 300U << 16 | 300U;  // the picture ends long before
  const OnDevice<std::uint32_t> corners(*device, corner.view(), "corners");
  const OnDevice<std::uint16_t> fractions(*device, size, "fractions");
  const OnDevice<std::uint8_t> src(*device, size, "src"), dst(*device, size, "dst"), inside(*device, size, "inside");
  auto recorder = must(vk::Recorder::make(*device));
  recorder.begin();
  corners.record_upload(recorder);
  rectify.record(recorder, src.view(), {corners.view(), fractions.view()}, dst.view(), inside.view(), size);
  must(recorder.end());
  must(recorder.run());
  ASSERT_FALSE(instance->messages().empty());
  EXPECT_NE(instance->messages()[0].find("out of bounds"), std::string::npos) << instance->messages()[0];
}

TEST(Validation, HearsTheWrongArgument) {
  const auto messages = messages_of([](const vk::Device& device, VkCommandBuffer commands, VkBuffer buffer) {
    device.fn().vkCmdFillBuffer(commands, buffer, 1, 4, 0);  // offsets are multiples of 4
  });
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("VUID-vkCmdFillBuffer-dstOffset"), std::string::npos) << messages[0];
}

}  // namespace
}  // namespace duo
