// Engines with the setups that a user can choose.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

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
