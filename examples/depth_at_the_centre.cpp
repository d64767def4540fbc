// How far is what the camera looks at? Two pictures and their rig in, metres out:
//   depth_at_the_centre left.png right.png rig.json
// Without arguments it looks at the synthetic room.
#include <cstdio>

#include "duoptic/engine.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"

int fail(const duo::Error& error) { return std::fprintf(stderr, "%s\n", error.what.c_str()), 1; }

int main(int argc, char** argv) {
  duo::Pair pair;
  duo::Setup setup;
  setup.wants.depth = true;
  if (argc == 4) {
    auto rig = duo::load_rig(argv[3]);
    if (!rig) return fail(rig.error());
    auto pairs = duo::open_pairs(argv[1], argv[2]);
    if (!pairs) return fail(pairs.error());
    if (auto next = (*pairs)->next(pair); !next) return fail(next.error());
    setup.rig = *rig;
  } else {
    duo::SyntheticPair room = duo::render_synthetic({}, 2);
    pair = std::move(room.pair);
    setup.rig = room.rig;
  }
  setup.size = pair.left.pixels.size();

  auto engine = duo::make_engine("auto", 2);
  if (!engine) return fail(engine.error());
  if (auto ready = (*engine)->prepare(setup); !ready) return fail(ready.error());
  (*engine)->submit(pair);
  const auto frame = (*engine)->collect();
  const auto& depth_mm = frame->depth_mm;
  const int mm = depth_mm.at(depth_mm.height() / 2, depth_mm.width() / 2);
  mm > 0 ? std::printf("%.2f m\n", mm / 1000.0) : std::printf("nothing known there\n");
}
