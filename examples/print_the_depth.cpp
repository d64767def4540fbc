// How far is what the camera looks at, frame by frame?
//   print_the_depth left.avi right.avi rig.json
// Without arguments it looks at the first frames of the synthetic person.
#include <cstdio>

#include "duoptic/pipeline.h"

int fail(const duo::Error& error) { return std::fprintf(stderr, "%s\n", error.what.c_str()), 1; }

int main(int argc, char** argv) {
  duo::PipelineSetup setup;
  setup.frames.wants.depth = true;
  auto pairs = argc == 4 ? duo::open_pairs(argv[1], argv[2]) : duo::open_pairs("synthetic:wave:320x240:2", "");
  if (!pairs) return fail(pairs.error());
  if (argc == 4) {
    auto rig = duo::load_rig(argv[3]);
    if (!rig) return fail(rig.error());
    setup.frames.rig = *rig;
  }
  auto pipeline = duo::Pipeline::open(std::move(*pairs), setup);
  if (!pipeline) return fail(pipeline.error());
  for (int frames = 0; argc == 4 || frames < 3;) {
    const auto next = pipeline->next();
    if (!next) return fail(next.error());
    if (*next == duo::Next::kNothing) continue;  // of a live source: none yet
    if (*next != duo::Next::kPicture) break;
    const auto& depth_mm = pipeline->frame()->depth_mm;
    std::printf("frame %d: %.2f m\n", frames++, depth_mm.at(depth_mm.height() / 2, depth_mm.width() / 2) / 1000.0);
  }
}
