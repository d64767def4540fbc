#include "matchers/pyramid/pyramid_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

/// A textured wall at 4 px with a box at 12 px in front of its middle third; the last columns of the right picture lie outside.
struct Scene {
  Image<std::uint8_t> left, right, left_inside, right_inside;
  explicit Scene(Size size, unsigned seed) : left(size), right(size), left_inside(size), right_inside(size) {
    std::mt19937 rng(seed);
    Image<std::uint8_t> texture({size.width + 64, size.height});
    test::fill(texture.view(), test::Fill::kRandom, rng);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.at(y, x) = texture.at(y, x);
        right.at(y, x) = texture.at(y, x + (x * 3 > size.width && x * 3 < 2 * size.width ? 12 : 4));
        left_inside.at(y, x) = x == 0 ? 0 : 255;
        right_inside.at(y, x) = x + 2 > size.width ? 0 : 255;
      }
  }
};

/// Two scenes with the same memory: the second must not see anything of the first.
void expect_agrees(vk::Device& device, const char* preset, const MatchSetup& setup, const std::string& where) {
  const PyramidParams params = *pyramid_params(preset, {});
  const auto matcher = must(vk::Pyramid::make(device, params, setup));
  ref::Pyramid reference(params, setup);
  StageTimer timer;
  auto recorder = must(vk::Recorder::make(device));
  for (const unsigned seed : {21U, 22U}) {
    const Scene scene(setup.size, seed);
    GrayPair pair{scene.left, scene.right};
    if (setup.masked) pair.left_inside = scene.left_inside, pair.right_inside = scene.right_inside;
    Image<std::uint16_t> want(setup.size);
    reference.match(pair, {want}, timer);

    const OnDevice<std::uint8_t> left(device, scene.left, "left"), right(device, scene.right, "right");
    const OnDevice<std::uint8_t> left_inside(device, scene.left_inside, "left inside"),
        right_inside(device, scene.right_inside, "right inside");
    const OnDevice<std::uint16_t> d_q4(device, setup.size, "d_q4");
    vk::Pyramid::Input input{left.view(), right.view()};
    if (setup.masked) input.left_inside = left_inside.view(), input.right_inside = right_inside.view();
    test::run_with(
        recorder, [&] { matcher.record(recorder, input, {d_q4.view()}); }, left, right, left_inside, right_inside, d_q4);
    const std::string what = std::string("pyramid ") + preset + (setup.masked ? " masked" : "") + where;
    if (!test::expect_same<std::uint16_t>(want, d_q4.pixels(what), what)) return;
  }
}

void expect_agrees_everywhere(const char* preset) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    for (const bool masked : {false, true})
      for (const auto& [size, max_disparity] : {std::pair{Size{150, 70}, 40}, {{33, 17}, 64}, {{1, 1}, 1}, {{5, 40}, 3}})
        expect_agrees(device, preset, {size, max_disparity, masked}, where);
  });
}

TEST(PyramidVk, DefaultAgrees) { expect_agrees_everywhere("default"); }
TEST(PyramidVk, ThesisAgrees) { expect_agrees_everywhere("thesis"); }

}  // namespace
}  // namespace duo
