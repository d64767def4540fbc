// How far away is what the camera looks at, frame by frame?
//   print_the_depth left.avi right.avi rig.json
#include <cstdio>

#include "duoptic/pipeline.h"

duo::Result<void> print_the_depth(const char* left, const char* right, const char* rig) {
  duo::PipelineSetup setup;
  setup.frames.wants.depth = true;
  DUO_TRY_ASSIGN(setup.frames.rig, duo::load_rig(rig));
  DUO_TRY_ASSIGN(auto pairs, duo::open_pairs(left, right));
  DUO_TRY_ASSIGN(auto pipeline, duo::Pipeline::open(std::move(pairs), setup));
  while (true) {
    DUO_TRY_ASSIGN(const duo::Next next, pipeline.next());
    if (next != duo::Next::kNew) return {};
    const duo::Image<std::uint16_t>& depth_mm = pipeline.frame()->depth_mm;
    std::printf("%.2f m\n", depth_mm.at(depth_mm.height() / 2, depth_mm.width() / 2) / 1000.0);
  }
}

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "print_the_depth LEFT RIGHT RIG\n"), 2;
  const auto done = print_the_depth(argv[1], argv[2], argv[3]);
  if (!done) std::fprintf(stderr, "%s\n", done.error().what.c_str());
  return done ? 0 : 1;
}
