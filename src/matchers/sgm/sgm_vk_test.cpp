#include "matchers/sgm/sgm_vk.h"

#include "tests/agree_vk.h"
#include "vulkan/timer.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

/// A textured wall at 4 px with a box at 12 px in front of its middle third; the right picture is darker, with less contrast,
/// and its last columns lie outside.
struct DarkerScene {
  Image<std::uint8_t> left, right, left_inside, right_inside;
  /// `levels`: of the texture; three are no noise.
  DarkerScene(Size size, unsigned seed, int levels = 256) : left(size), right(size), left_inside(size), right_inside(size) {
    std::mt19937 rng(seed);
    Image<std::uint8_t> texture({size.width + 64, size.height});
    test::fill(texture.view(), test::Fill::kRandom, rng);
    for (int y = 0; y < texture.height(); ++y)
      for (int x = 0; x < texture.width(); ++x)
        if (levels < 256) texture.at(y, x) = static_cast<std::uint8_t>(100 + texture.at(y, x) % levels);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.at(y, x) = texture.at(y, x);
        right.at(y, x) =
            static_cast<std::uint8_t>(texture.at(y, x + (x * 3 > size.width && x * 3 < 2 * size.width ? 12 : 4)) * 7 / 10);
        left_inside.at(y, x) = x == 0 ? 0 : 255;
        right_inside.at(y, x) = x + 2 > size.width ? 0 : 255;
      }
  }
};

/// Two scenes with the same memory: the second must not see anything of the first.
void expect_sgm_agrees(vk::Device& device, const SgmParams& params, const MatchSetup& setup, bool wants_confidence,
                       const std::string& where, int coding_noise_q4 = 0) {
  const auto coding = must(vk::make_filled(device, "coding", std::as_bytes(std::span(&coding_noise_q4, 1))));
  const auto matcher = must(vk::Sgm::make(device, params, setup));
  ref::Sgm reference(params, setup);
  StageTimer timer;
  auto recorder = must(vk::Recorder::make(device));
  for (const unsigned seed : {21U, 22U}) {
    const DarkerScene scene(setup.size, seed, coding_noise_q4 != 0 ? 3 : 256);
    GrayPair pair{scene.left, scene.right};
    pair.coding_noise_q4 = coding_noise_q4;
    if (setup.masked) pair.left_inside = scene.left_inside, pair.right_inside = scene.right_inside;
    Image<std::uint16_t> want(setup.size);
    Image<std::uint8_t> sure(setup.size);
    reference.match(pair, {want, sure}, timer);

    const OnDevice<std::uint8_t> left(device, scene.left, "left"), right(device, scene.right, "right");
    const OnDevice<std::uint8_t> left_inside(device, scene.left_inside, "left inside"),
        right_inside(device, scene.right_inside, "right inside"), confidence(device, setup.size, "confidence");
    const OnDevice<std::uint16_t> d_q4(device, setup.size, "d_q4");
    vk::Sgm::Input input{left.view(), right.view()};
    if (coding_noise_q4 != 0) input.coding_noise_q4 = &coding;
    if (setup.masked) input.left_inside = left_inside.view(), input.right_inside = right_inside.view();
    vk::Sgm::Output out{d_q4.view()};
    if (wants_confidence) out.confidence = confidence.view();
    test::run_with(
        recorder, [&] { matcher.record(recorder, input, out); }, left, right, left_inside, right_inside, d_q4, confidence);
    const std::string what = "sgm paths " + std::to_string(params.paths) + (setup.masked ? " masked" : "") + where;
    if (!test::expect_same<std::uint16_t>(want, d_q4.pixels(what), what)) return;
    if (wants_confidence && !test::expect_same<std::uint8_t>(sure, confidence.pixels(what), what + " confidence")) return;
  }
}

MatchSetup denoised(Size size) {
  MatchSetup setup{size, 16, true};
  setup.denoised = true;
  return setup;
}

TEST(SgmVk, PresetsAgree) {
  test::each_device([](vk::Device& device, const std::string& where) {
    for (const char* preset : {"default", "paths8"}) {
      const SgmParams params = *sgm_params(preset, {{"refine", 2}});
      expect_sgm_agrees(device, params, {{90, 30}, 20, false}, false, where);
      expect_sgm_agrees(device, params, {{33, 17}, 70, true}, true, where);
      expect_sgm_agrees(device, params, {{1, 1}, 1, true}, true, where);
      if (::testing::Test::HasFailure()) return;
    }
  });
}

TEST(SgmVk, AgreesUnsmoothed) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const SgmParams params =
        *sgm_params("default", {{"paths", 4}, {"smooth", 0}, {"speckle", 20}, {"reach", 0}, {"refine", 1}});
    expect_sgm_agrees(device, params, denoised({61, 24}), true, where);
  });
}

TEST(SgmVk, AgreesOnClearPictures) {
  test::each_device([](vk::Device& device, const std::string& where) {
    for (const int clear : {0, 2})
      expect_sgm_agrees(device, *sgm_params("default", {{"clear", clear}}), denoised({61, 24}), true, where);
  });
}

TEST(SgmVk, AgreesOnCodedPictures) {
  test::each_device([](vk::Device& device, const std::string& where) {
    for (const int coding_noise_q4 : {24, 70})
      expect_sgm_agrees(device, *sgm_params("default", {{"refine", 1}}), denoised({61, 24}), true, where, coding_noise_q4);
  });
}

// A frame's times read alike whichever engine took them.
TEST(SgmVk, TimesTheReferencesStages) {
  const Size size{20, 9};
  const SgmParams params = *sgm_params("default", {});
  const DarkerScene scene(size, 23);
  Image<std::uint16_t> found(size);
  StageTimer reference_timer;
  StageTimer::Times want;
  reference_timer.start(want, true);
  ref::Sgm(params, {size, 8, false}).match({scene.left, scene.right}, {found}, reference_timer);
  test::each_device([&](vk::Device& device, const std::string&) {
    const auto matcher = must(vk::Sgm::make(device, params, {size, 8, false}));
    const OnDevice<std::uint8_t> left(device, scene.left, "left"), right(device, scene.right, "right");
    const OnDevice<std::uint16_t> d_q4(device, size, "d_q4");
    auto timer = must(vk::Timer::make(device, 16));
    auto recorder = must(vk::Recorder::make(device));
    recorder.begin(&timer);
    left.record_upload(recorder);
    right.record_upload(recorder);
    matcher.record(recorder, {left.view(), right.view()}, {d_q4.view()});
    must(recorder.end());
    must(recorder.run());
    std::size_t stages = 0;
    for (const auto& [stage, ns] : must(timer.read())) EXPECT_STREQ(stage, want[stages++].stage);
    EXPECT_EQ(want[stages].wall_ns, 0);
  });
}

}  // namespace
}  // namespace duo
