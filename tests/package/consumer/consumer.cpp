// What an installed library must do in another project: make a frame, find the networks, and be the one of the headers.
#include <duoptic/duoptic.h>
#include <duoptic/synthetic.h>

#include <cstdio>
#include <string>

int main() {
  duo::SyntheticPair room = duo::render_synthetic({.size = {160, 120}}, 1);
  duo::Setup setup{.size = {160, 120}, .rig = room.rig, .wants = {.depth = true}};
  const auto engine = duo::make_engine("simd", 1);
  if (!engine || !(*engine)->prepare(setup)) return 1;
  (*engine)->submit(room.pair);
  const auto frame = (*engine)->collect();
  const auto detector = duo::make_detector({.body = duo::BodyModel::kLite});
  if (!detector) return std::fprintf(stderr, "%s\n", detector.error().what.c_str()), 1;
  const std::string of_headers = std::to_string(DUOPTIC_VERSION_MAJOR) + "." + std::to_string(DUOPTIC_VERSION_MINOR) + "." +
                                 std::to_string(DUOPTIC_VERSION_PATCH);
  if (of_headers != duo::version()) return std::fprintf(stderr, "headers are of %s\n", of_headers.c_str()), 1;
  std::printf("%s %.1f m, networks in %s\n", duo::version(), frame->depth_mm.at(60, 80) / 1000.0, duo::models_folder().c_str());
}
