#include "matchers/sgm/sgm_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

/// A textured wall at 4 px with a box at 12 px in front of its middle third, some noise in both views; the right camera is
/// darker and has less contrast. Holes in both inside pictures.
struct Scene {
  Image<std::uint8_t> left, right, left_inside, right_inside;
  Scene(Size size, unsigned seed) : left(size), right(size), left_inside(size), right_inside(size) {
    std::mt19937 rng(seed);
    Image<std::uint8_t> texture({size.width + 64, size.height});
    test::fill(texture.view(), test::Fill::kRandom, rng);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const int shown = texture.at(y, x + (x * 3 > size.width && x * 3 < 2 * size.width ? 12 : 4));
        left.at(y, x) = texture.at(y, x);
        right.at(y, x) = static_cast<std::uint8_t>(rng() % 8 ? shown * 7 / 10 : rng() % 256);
        left_inside.at(y, x) = x == 0 || rng() % 23 == 0 ? 0 : 255;
        right_inside.at(y, x) = x + 2 > size.width || rng() % 23 == 0 ? 0 : 255;
      }
  }
};

struct Case {
  const char* preset;
  Overrides overrides;
  MatchSetup setup;
  bool confidence;
};

/// Two scenes with the same memory: the second must not see anything of the first.
void expect_agrees(vk::Device& device, const Case& c, const std::string& where) {
  const SgmParams params = *sgm_params(c.preset, c.overrides);
  const MatchSetup& setup = c.setup;
  const auto matcher = must(vk::Sgm::make(device, params, setup));
  ref::Sgm reference(params, setup);
  StageTimer timer;
  auto recorder = must(vk::Recorder::make(device));
  for (const unsigned seed : {21U, 22U}) {
    const Scene scene(setup.size, seed);
    GrayPair pair{scene.left, scene.right};
    if (setup.masked) pair.left_inside = scene.left_inside, pair.right_inside = scene.right_inside;
    Image<std::uint16_t> want(setup.size);
    Image<std::uint8_t> want_confidence(setup.size);
    reference.match(pair, {want, c.confidence ? want_confidence.view() : View<std::uint8_t>{}}, timer);

    const OnDevice<std::uint8_t> left(device, scene.left, "left"), right(device, scene.right, "right");
    const OnDevice<std::uint8_t> left_inside(device, scene.left_inside, "left inside"),
        right_inside(device, scene.right_inside, "right inside");
    const OnDevice<std::uint16_t> d_q4(device, setup.size, "d_q4");
    const OnDevice<std::uint8_t> confidence(device, setup.size, "confidence");
    vk::Sgm::Input input{left.view(), right.view()};
    if (setup.masked) input.left_inside = left_inside.view(), input.right_inside = right_inside.view();
    test::run_with(
        recorder,
        [&] {
          matcher.record(recorder, input, d_q4.view(), c.confidence ? confidence.view() : vk::BufferView<std::uint8_t>{});
        },
        left, right, left_inside, right_inside, d_q4, confidence);
    const std::string what = std::string("sgm ") + c.preset + (setup.masked ? " masked" : "") + where;
    if (!test::expect_same<std::uint16_t>(want, d_q4.pixels(what), what)) return;
    if (c.confidence && !test::expect_same<std::uint8_t>(want_confidence, confidence.pixels(what), what + " confidence"))
      return;
  }
}

// Islands of fewer than 60 px would be all there is in pictures this small.
TEST(SgmVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const Case cases[] = {{"default", {}, {{90, 30}, 20, false}, true},
                          {"default", {{"speckle", 9}}, {{33, 17}, 37, true}, true},
                          {"default", {{"speckle", 3}, {"smooth", 0}}, {{41, 9}, 20, true}, false},
                          {"paths8", {{"speckle", 9}}, {{61, 23}, 20, true}, true},
                          {"paths8", {}, {{1, 1}, 1, false}, true}};
    for (const Case& c : cases) {
      expect_agrees(device, c, where);
      if (::testing::Test::HasFailure()) return;
    }
  });
}

TEST(SgmVk, SaysWhatIsTooLarge) {
  test::each_device([](vk::Device& device, const std::string&) {
    const auto matcher = vk::Sgm::make(device, *sgm_params("default", {}), {{1920, 1080}, 256, false});
    ASSERT_FALSE(matcher.has_value());
    EXPECT_NE(matcher.error().what.find("1920x1080 pixels with 256 disparities"), std::string::npos) << matcher.error().what;
  });
}

}  // namespace
}  // namespace duo
