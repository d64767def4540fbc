// match_frames MATCHER FRAMES: one thread matches the synthetic room so many times; MATCHER+focus: the middle quarter of it. Run
// under callgrind by count_instructions.sh, which counts what comes after the first frame.
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else  // then there is no valgrind to count with, and the script says so
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#endif

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "duoptic/engine.h"
#include "duoptic/synthetic.h"

// Highway's library measures its clock as it is loaded, on some processors with an instruction that valgrind ends programs for
// (RDTSCP).
namespace hwy::platform {
__attribute__((visibility("default"))) std::uint64_t TimerResolution() { return 1; }
}  // namespace hwy::platform

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  duo::SyntheticSetup room;
  room.size = {160, 120};
  room.ideal = true;
  const duo::SyntheticPair scene = duo::render_synthetic(room, 1);
  auto engine = duo::make_engine("simd", 1);
  duo::Setup setup;
  setup.size = room.size;
  const std::string name = argv[1];
  setup.matcher = name.substr(0, name.find('+'));
  setup.max_disparity = 64;
  setup.fill = true;
  if (!engine || !(*engine)->prepare(setup)) return 1;
  if (name.ends_with("+focus")) (*engine)->focus({{40, 30, 80, 60}, 0, 64});
  unsigned sum = 0;
  const auto frame = [&] {
    (*engine)->submit(scene.pair);
    sum += (*engine)->collect()->disparity.d_q4.at(60, 80);
  };
  frame();
  CALLGRIND_START_INSTRUMENTATION;
  for (int i = std::atoi(argv[2]); i > 0; --i) frame();
  CALLGRIND_STOP_INSTRUMENTATION;
  std::printf("%u\n", sum);
}
