// What takes part in tables of frames.
#pragma once

namespace duo {

inline constexpr int kBenchDisparities = 128;

struct BenchChoice {
  const char *matcher, *preset;
};
inline constexpr BenchChoice kBenchChoices[] = {
    {"sgm", "default"}, {"sgm", "paths8"}, {"pyramid", "default"}, {"pyramid", "thesis"}};

}  // namespace duo
