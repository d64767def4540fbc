// Engines with the setups that a user can choose.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/synthetic.h"

namespace duo::test {

inline std::unique_ptr<Engine> prepared(const char* name, int threads, const duo::Setup& setup) {
  auto engine = make_engine(name, threads);
  EXPECT_TRUE(engine) << engine.error().what;
  const auto ready = (*engine)->prepare(setup);
  EXPECT_TRUE(ready) << ready.error().what;
  return std::move(*engine);
}

inline std::shared_ptr<const Frame> run(Engine& engine, const Pair& pair) {
  engine.submit(pair);
  return engine.collect();
}

/// Little, sharp texture 4 px apart in both views; or more of it, blurred.
inline Pair low_texture(bool sharp, unsigned seed) {
  const Size size{72, 48};
  std::mt19937 rng(seed);
  Image<std::uint8_t> texture({size.width + 16, size.height + 8});
  for (int y = 0; y < texture.height(); ++y)
    for (int x = 0; x < texture.width(); ++x)
      texture.at(y, x) = static_cast<std::uint8_t>(100 + (sharp ? rng() % 3 : rng() % 60));
  Pair out;
  for (auto [picture, shift] : {std::pair{&out.left, 0}, std::pair{&out.right, 4}}) {
    picture->pixels = Image<Rgb8>(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        int sum = 0;
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i) sum += texture.at(y + (sharp ? 0 : j), x + shift + (sharp ? 0 : i));
        const auto v = static_cast<std::uint8_t>(sum / 16);
        picture->pixels.at(y, x) = {v, v, v};
      }
  }
  return out;
}

/// What a user can choose.
struct Choice {
  const char *matcher, *preset;
};
inline constexpr Choice kChoices[] = {{"sgm", "default"}, {"sgm", "paths8"}, {"pyramid", "default"}, {"pyramid", "thesis"}};

inline duo::Setup raw_setup(const SyntheticPair& scene, const Choice& choice) {
  duo::Setup setup;
  setup.size = scene.pair.left.pixels.size();
  setup.rig = scene.rig;
  setup.matcher = choice.matcher;
  setup.preset = choice.preset;
  setup.max_disparity = 48;
  setup.denoise = Denoise::kBoth;
  setup.fill = true;
  setup.wants = {.color = true, .depth = true};
  return setup;
}

}  // namespace duo::test
