// The Vulkan engine: the reference's bits, pairs in flight, only what is wanted sent back, little work for the CPU, and no
// frame missing when the device or its memory goes.

#include <map>
#include <utility>

#include "duoptic/synthetic.h"
#include "engines/engines.h"
#include "tests/agree_vk.h"
#include "tests/allocations.h"
#include "tests/engine_setups.h"
#include "tests/watched_device.h"
#include "vulkan/frame_on_device.h"

namespace duo {
namespace {

using test::calls, test::low_texture, test::must, test::OwnDevice, test::thread_ns, test::watch;

/// Rendered once for all tests.
const SyntheticPair& room(std::uint32_t seed = 2) {
  static std::map<std::uint32_t, SyntheticPair> rooms;
  const auto [at, is_new] = rooms.try_emplace(seed);
  if (is_new) at->second = render_synthetic({.size = {96, 72}, .seed = seed}, 2);
  return at->second;
}

duo::Setup setup_for(const SyntheticPair& scene) {
  duo::Setup setup;
  setup.size = scene.pair.left.pixels.size();
  setup.rig = scene.rig;
  setup.matcher = "pyramid";
  setup.preset = "thesis";
  setup.max_disparity = 24;
  setup.wants = {.color = true, .depth = true};
  return setup;
}

std::shared_ptr<const Frame> run(Engine& engine, const Pair& pair) {
  engine.submit(pair);
  return engine.collect();
}

void expect_same_frame(const Frame& want, const Frame& got, const std::string& who) {
  EXPECT_EQ(want.sequence, got.sequence) << who;
  EXPECT_EQ(want.t_ns, got.t_ns) << who;
  EXPECT_EQ(want.skew_ns, got.skew_ns) << who;
  test::expect_same<std::uint8_t>(want.left, got.left, who + " left");
  test::expect_same<std::uint8_t>(want.right, got.right, who + " right");
  test::expect_same<std::uint8_t>(want.left_inside, got.left_inside, who + " left inside");
  test::expect_same<std::uint8_t>(want.right_inside, got.right_inside, who + " right inside");
  test::expect_same<std::uint16_t>(want.disparity.d_q4, got.disparity.d_q4, who + " disparity");
  test::expect_same<std::uint8_t>(want.disparity.origin, got.disparity.origin, who + " origin");
  test::expect_same<std::uint16_t>(want.depth_mm, got.depth_mm, who + " depth");
  if (!want.confidence.empty()) test::expect_same<std::uint8_t>(want.confidence, got.confidence, who + " confidence");
  ASSERT_EQ(want.color.size(), got.color.size()) << who;
  for (int y = 0; y < want.color.height(); ++y)
    ASSERT_EQ(std::memcmp(want.color.row(y), got.color.row(y), sizeof(Rgb8) * static_cast<std::size_t>(want.color.width())), 0)
        << who << " color, row " << y;
}

std::unique_ptr<Engine> prepared(std::unique_ptr<Engine> engine, const duo::Setup& setup) {
  const auto ready = engine->prepare(setup);
  EXPECT_TRUE(ready) << ready.error().what;
  return engine;
}

/// What the reference makes of a room, in the setup of room(); made once for all tests.
const Frame& wanted(std::uint32_t seed = 2) {
  static std::map<std::uint32_t, std::shared_ptr<const Frame>> frames;
  auto& frame = frames[seed];
  if (frame == nullptr) frame = run(*prepared(make_ref_engine(), setup_for(room())), room(seed).pair);
  return *frame;
}

struct Case {
  const char* name;
  void (*change)(duo::Setup&);
};
const Case kCases[] = {
    {"thesis", [](duo::Setup&) {}},
    {"thesis, all denoising, filled", [](duo::Setup& s) { s.denoise = Denoise::kBoth, s.fill = true; }},
    {"sgm", [](duo::Setup& s) { s.matcher = "sgm", s.preset = "default", s.wants.confidence = true; }},
    {"sgm, filled, odd search",
     [](duo::Setup& s) { s.matcher = "sgm", s.preset = "paths8", s.fill = true, s.max_disparity = 21; }},
    {"pyramid", [](duo::Setup& s) { s.preset = "default"; }},
    {"thesis, taken as rectified", [](duo::Setup& s) { s.rig.reset(), s.wants.depth = false; }},
    {"thesis, rows put right",
     [](duo::Setup& s) {
       s.rig.reset(), s.wants.depth = false;
       s.rows = RowOffsets{s.size, {0.7, -0.4, 0.3, 0, 0.2, 0}, -1, 1.2, 100, 0.7, 0.1};
     }},
};

TEST(VulkanEngine, AgreesWithTheReference) {
  const SyntheticPair&scene = room(), &other = room(5);
  for (const Case& each : kCases) {
    duo::Setup setup = setup_for(scene);
    each.change(setup);
    OwnDevice device;
    const auto reference = prepared(make_ref_engine(), setup), vulkan = prepared(device.engine(), setup);
    EXPECT_STREQ(vulkan->name(), "vulkan");
    EXPECT_FALSE(vulkan->device().empty());
    for (const SyntheticPair* pair : {&scene, &other, &scene})
      expect_same_frame(*run(*reference, pair->pair), *run(*vulkan, pair->pair), each.name);
    EXPECT_EQ(vulkan->take_event(), "");
  }
}

TEST(VulkanEngine, KeepsPairsInFlightInOrder) {
  const SyntheticPair* const scenes[] = {&room(), &room(5), &room(7)};
  const duo::Setup setup = setup_for(*scenes[0]);
  OwnDevice device;
  const auto vulkan = prepared(device.engine(), setup);
  ASSERT_EQ(vulkan->in_flight(), 2);
  vulkan->submit(scenes[0]->pair);
  vulkan->submit(scenes[1]->pair);
  const std::shared_ptr<const Frame> first = vulkan->collect();
  vulkan->submit(scenes[2]->pair);
  const std::shared_ptr<const Frame> second = vulkan->collect();
  expect_same_frame(wanted(), *first, "first, after the second was made");
  expect_same_frame(wanted(5), *second, "second");
  expect_same_frame(wanted(7), *vulkan->collect(), "third");
}

// What a stream knows of its pictures stays on the device from pair to pair, two in flight, and is forgotten by prepare().
TEST(VulkanEngine, SettlesWhatIsClear) {
  constexpr int kSharp = 2, kPairs = kSharp + 32;
  std::vector<Pair> pairs;
  for (int i = 0; i < kPairs; ++i) pairs.push_back(low_texture(i < kSharp, static_cast<unsigned>(i)));
  duo::Setup setup;
  setup.size = pairs[0].left.pixels.size();
  setup.max_disparity = 16;
  OwnDevice device;
  const auto reference = prepared(make_ref_engine(), setup), vulkan = prepared(device.engine(), setup);
  for (int round = 0; round < 2; ++round) {
    for (int i = 0, submitted = 0; i < kPairs; ++i) {
      for (; submitted < std::min(kPairs, i + 2); ++submitted) vulkan->submit(pairs[static_cast<std::size_t>(submitted)]);
      const auto want = run(*reference, pairs[static_cast<std::size_t>(i)])->disparity.d_q4.clone();
      if (!test::expect_same<std::uint16_t>(want, vulkan->collect()->disparity.d_q4, "pair " + std::to_string(i))) return;
    }
    ASSERT_TRUE(reference->prepare(setup));
    ASSERT_TRUE(vulkan->prepare(setup));
  }
}

// Noise of coding belongs to its pair, also while another one is in flight.
TEST(VulkanEngine, TakesTheCodingNoiseOfEachPair) {
  std::vector<Pair> pairs;
  for (unsigned i = 0; i < 3; ++i) pairs.push_back(low_texture(false, i));
  pairs[0].left.coding_noise_q4 = 29;
  pairs[2].right.coding_noise_q4 = 44;
  duo::Setup setup;
  setup.size = pairs[0].left.pixels.size();
  setup.max_disparity = 16;
  OwnDevice device;
  const auto reference = prepared(make_ref_engine(), setup), vulkan = prepared(device.engine(), setup);
  vulkan->submit(pairs[0]);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i + 1 < pairs.size()) vulkan->submit(pairs[i + 1]);
    const auto want = run(*reference, pairs[i])->disparity.d_q4.clone();
    test::expect_same<std::uint16_t>(want, vulkan->collect()->disparity.d_q4, "pair " + std::to_string(i));
  }
}

// Windows belong to the pair submitted after them, also while another one is in flight.
TEST(VulkanEngine, CutsTheWindowsOfEachPair) {
  const SyntheticPair* const scenes[] = {&room(), &room(5)};
  const duo::Setup setup = setup_for(*scenes[0]);
  OwnDevice device;
  const auto reference = prepared(make_ref_engine(), setup), vulkan = prepared(device.engine(), setup);
  const Window window[] = {{20, 10, 30, 20}};
  vulkan->look_at(window);
  vulkan->submit(scenes[0]->pair);
  vulkan->look_at({});
  vulkan->submit(scenes[1]->pair);
  reference->look_at(window);
  expect_same_frame(*run(*reference, scenes[0]->pair), *vulkan->collect(), "in a window");
  reference->look_at({});
  expect_same_frame(*run(*reference, scenes[1]->pair), *vulkan->collect(), "whole");
}

// Also the frame that is under way on the device.
TEST(VulkanEngine, TheCpuLooksAroundPeople) {
  const SyntheticPair& scene = room();
  duo::Setup setup = setup_for(scene);
  setup.matcher = "sgm", setup.preset = "default";
  const Focus part{{20, 10, 40, 30}, 4, 20};
  OwnDevice device;
  const auto reference = prepared(make_ref_engine(), setup), vulkan = prepared(device.engine(), setup);
  ASSERT_TRUE(vulkan->can_focus());
  vulkan->submit(scene.pair);
  vulkan->focus(part);
  vulkan->submit(scene.pair);
  EXPECT_STREQ(vulkan->name(), "simd");
  EXPECT_NE(vulkan->take_event().find("match parts of pictures on a device"), std::string::npos);
  expect_same_frame(*run(*reference, scene.pair), *vulkan->collect(), "whole");
  reference->focus(part);
  const auto want = run(*reference, scene.pair);
  EXPECT_EQ(want->disparity.d_q4.at(0, 0), Disparity::kNone);
  expect_same_frame(*want, *vulkan->collect(), "part");
  // Focus and CPU end with the next setup.
  ASSERT_TRUE(vulkan->prepare(setup) && reference->prepare(setup));
  EXPECT_STREQ(vulkan->name(), "vulkan");
  expect_same_frame(*run(*reference, scene.pair), *run(*vulkan, scene.pair), "whole again");
}

// What stays on the device is there for the two last frames; whoever uses an older one, or one whose engine is gone, is told.
TEST(VulkanEngine, FramesOnTheDeviceAreThereOrSayThatTheyAreNot) {
  const SyntheticPair& scene = room();
  duo::Setup setup = setup_for(scene);
  setup.wants = {.views = false, .disparity = false, .on_device = true};
  OwnDevice device;
  auto vulkan = prepared(device.engine(), setup);
  const auto uses = [](const Frame& frame) {
    return dynamic_cast<vk::FrameOnDevice&>(*frame.on_device).use([](const auto&, int) { return Result<void>(); }).has_value();
  };
  std::vector<std::shared_ptr<const Frame>> frames;
  for (std::size_t i = 0; i < 6; ++i) {
    frames.push_back(run(*vulkan, scene.pair));
    ASSERT_NE(frames[i]->on_device, nullptr);
    EXPECT_TRUE(uses(*frames[i])) << i;
    EXPECT_TRUE(i == 0 || uses(*frames[i - 1])) << i;
  }
  EXPECT_FALSE(uses(*frames[0]));
  EXPECT_FALSE(uses(*frames[1]));
  EXPECT_TRUE(uses(*frames[5])) << "an old frame takes nothing from a new one";
  EXPECT_EQ(vulkan->take_event(), "");
  ASSERT_TRUE(vulkan->prepare(setup));
  EXPECT_FALSE(uses(*frames[5])) << "of the setup before";
  frames.push_back(run(*vulkan, scene.pair));
  EXPECT_TRUE(uses(*frames[6]));
  vulkan.reset();
  EXPECT_FALSE(uses(*frames[6]));
}

TEST(VulkanEngine, SendsOnlyWhatIsWanted) {
  const SyntheticPair& scene = room();
  duo::Setup setup = setup_for(scene);
  setup.wants = {.views = false, .disparity = false};
  OwnDevice device;
  const auto vulkan = prepared(device.engine(), setup);
  const std::shared_ptr<const Frame> none = run(*vulkan, scene.pair);
  EXPECT_TRUE(none->left.empty() && none->right.empty() && none->left_inside.empty() && none->disparity.d_q4.empty());
  setup.wants.disparity = true;
  ASSERT_TRUE(vulkan->prepare(setup));
  const std::shared_ptr<const Frame> some = run(*vulkan, scene.pair);
  EXPECT_TRUE(some->left.empty());
  test::expect_same<std::uint16_t>(wanted().disparity.d_q4, some->disparity.d_q4, "disparity alone");
}

TEST(VulkanEngine, RefusesWhatCannotWorkAndStaysAsItWas) {
  const SyntheticPair& scene = room();
  duo::Setup setup = setup_for(scene);
  OwnDevice device;
  const auto vulkan = prepared(device.engine(), setup);
  duo::Setup wrong = setup;
  wrong.max_disparity = 0;
  EXPECT_FALSE(vulkan->prepare(wrong));
  expect_same_frame(wanted(), *run(*vulkan, scene.pair), "after a refused setup");
}

TEST(VulkanEngine, LeavesTheCpuFree) {
  SyntheticSetup synthetic;
  synthetic.size = {320, 240};
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  duo::Setup setup = setup_for(scene);
  setup.wants = {.views = false, .disparity = false};
  OwnDevice device(vk::Validation::kOff);  // the layer allocates
  watch(device.calls());
  const auto vulkan = prepared(device.engine(), setup);
  run(*vulkan, scene.pair);
  // A quarter of VGA's pixels in a quarter of its millisecond.
  constexpr double kMost_ns = 250'000;
  double least_ns = 1e9;
  // The least of many, beside a copy: what a busy machine adds is not ours.
  for (int i = 0; i < 4 || (least_ns >= kMost_ns && i < 100); ++i) {
    const long allocations = test::allocations;
    const int submits = calls.submits;
    const std::int64_t begin_ns = thread_ns(), inside_ns = calls.inside_ns;
    run(*vulkan, scene.pair);
    const auto took_ns = static_cast<double>(thread_ns() - begin_ns - (calls.inside_ns - inside_ns));
    least_ns = std::min(least_ns, took_ns / test::slowdown());
    EXPECT_LE(calls.submits - submits, 2);
    EXPECT_EQ(test::allocations - allocations, 0);
  }
#ifdef NDEBUG  // sanitizers watch every byte
  EXPECT_LT(least_ns, kMost_ns);
#endif
}

void expect_cpu_goes_on(void (*injure)(), const char* how) {
  const SyntheticPair* const scenes[] = {&room(), &room(5)};
  const duo::Setup setup = setup_for(*scenes[0]);
  OwnDevice device;
  watch(device.calls());
  injure();
  const auto vulkan = prepared(device.engine(), setup);
  std::string events;
  for (int i = 0; i < 6; ++i) {
    expect_same_frame(wanted(i % 2 == 0 ? 2 : 5), *run(*vulkan, scenes[i % 2]->pair), std::string(how) + ", frame " + std::to_string(i));
    events += vulkan->take_event();
  }
  EXPECT_NE(events.find("the CPU goes on"), std::string::npos) << how << ": " << events;
  EXPECT_EQ(events.find("the CPU goes on"), events.rfind("the CPU goes on")) << "told once: " << events;
}

TEST(VulkanEngine, CpuGoesOnWhenTheDeviceIsLost) {
  expect_cpu_goes_on([] { calls.fail_submit_at = 8; }, "lost at a submit");
  expect_cpu_goes_on([] { calls.fail_wait_at = 8; }, "lost while waiting");
}

TEST(VulkanEngine, CpuGoesOnWithoutDeviceMemory) {
  expect_cpu_goes_on([] { calls.allocations_left = 0; }, "no memory at all");
  expect_cpu_goes_on([] { calls.allocations_left = 1; }, "memory for some");
}

// What one setup is too large for, another may not be; and who computes is told as it is.
TEST(VulkanEngine, TriesTheDeviceAgainAtTheNextSetup) {
  const SyntheticPair& scene = room();
  const duo::Setup setup = setup_for(scene);
  OwnDevice device;
  watch(device.calls());
  calls.allocations_left = 0;
  const auto vulkan = prepared(device.engine(), setup);
  EXPECT_NE(vulkan->take_event().find("the CPU goes on"), std::string::npos);
  EXPECT_STREQ(vulkan->name(), "simd");
  EXPECT_EQ(vulkan->device(), "");
  expect_same_frame(wanted(), *run(*vulkan, scene.pair), "on the CPU");
  calls.allocations_left = 1 << 30;
  ASSERT_TRUE(vulkan->prepare(setup));
  EXPECT_EQ(vulkan->take_event(), "");
  EXPECT_STREQ(vulkan->name(), "vulkan");
  EXPECT_FALSE(vulkan->device().empty());
  expect_same_frame(wanted(), *run(*vulkan, scene.pair), "on the device again");
}

TEST(VulkanEngine, PairsInFlightSurviveTheLoss) {
  const SyntheticPair* const scenes[] = {&room(), &room(5)};
  const duo::Setup setup = setup_for(*scenes[0]);
  OwnDevice device;
  watch(device.calls());
  const auto vulkan = prepared(device.engine(), setup);
  calls.fail_wait_at = calls.waits;
  vulkan->submit(scenes[0]->pair);
  vulkan->submit(scenes[1]->pair);
  expect_same_frame(wanted(), *vulkan->collect(), "the pair it was lost on");
  expect_same_frame(wanted(5), *vulkan->collect(), "the pair behind");
}

// Nothing that the device may still write to is freed: validation would speak, and so would the software driver.
TEST(VulkanEngine, CpuGoesOnWhenTheDeviceHangs) {
  const SyntheticPair* const scenes[] = {&room(), &room(5)};
  const duo::Setup setup = setup_for(*scenes[0]);
  OwnDevice device;
  watch(device.calls());
  const auto vulkan = prepared(device.engine(), setup);
  calls.hang_at = calls.waits;
  vulkan->submit(scenes[0]->pair);
  vulkan->submit(scenes[1]->pair);
  expect_same_frame(wanted(), *vulkan->collect(), "the pair it hung on");
  expect_same_frame(wanted(5), *vulkan->collect(), "the pair behind");
  EXPECT_EQ(vulkan->device(), "");
}

}  // namespace
}  // namespace duo
