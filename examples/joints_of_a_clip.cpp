// Where are people's hands, and what is the depth there? Two videos or cameras with their rig, or a recording, which has its
// own:
//   joints_of_a_clip left.avi right.avi rig.json
//   joints_of_a_clip camera:0 camera:2 rig.json
//   joints_of_a_clip clip.mkv
#include <duoptic/duoptic.h>

#include <cstdio>

duo::Result<void> print_the_hands(int argc, char** argv) {
  duo::PipelineSetup setup;
  setup.tracker = "body";
  setup.frames.wants.depth = true;
  if (argc > 3) {
    DUO_TRY_ASSIGN(setup.frames.rig, duo::load_rig(argv[3]));
  }
  DUO_TRY_ASSIGN(auto pairs, duo::open_pairs(argv[1], argc > 2 ? argv[2] : ""));
  DUO_TRY_ASSIGN(auto pipeline, duo::Pipeline::open(std::move(pairs), setup));
  while (true) {
    DUO_TRY_ASSIGN(const duo::Next next, pipeline.next());
    if (next == duo::Next::kNothing) continue;  // a camera is away: it may come back
    if (next != duo::Next::kNew) return {};
    for (const duo::Person& person : pipeline.people()) {
      const duo::Joint* hand = person.find(duo::JointId::kRightHand);
      if (hand == nullptr || hand->state == duo::JointState::kLost) continue;
      const duo::Vec3 p_m = hand->p_in_rig_m;
      std::printf("%.2f s: person %u's right hand at (%.2f, %.2f, %.2f) m +- %.0f mm, %s", pipeline.tracked().t_s, person.id,
                  p_m.x, p_m.y, p_m.z, 1000 * hand->sigma_m(), hand->state == duo::JointState::kSeen ? "seen" : "inferred");
      const duo::Vec2 at_px = pipeline.rectified()->project(p_m);
      const duo::Window pixel{static_cast<int>(at_px.x), static_cast<int>(at_px.y), 1, 1};
      if (!pixel.within(pipeline.frame()->depth_mm.size()).empty())
        std::printf("; the depth there is %.2f m", pipeline.frame()->depth_mm.at(pixel.y, pixel.x) / 1000.0);
      std::printf("\n");
    }
  }
}

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) return std::fprintf(stderr, "joints_of_a_clip LEFT [RIGHT [RIG]]\n"), 2;
  const auto done = print_the_hands(argc, argv);
  if (!done) std::fprintf(stderr, "%s\n", done.error().what.c_str());
  return done ? 0 : 1;
}
