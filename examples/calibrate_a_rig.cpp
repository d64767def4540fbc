// A rig from pictures of a board: two folders (or videos), the board as docs/calibrate.md names it, the side of its squares.
//   calibrate_a_rig left_pictures right_pictures charuco:9x6 30 rig.json
#include <duoptic/duoptic.h>

#include <cstdio>
#include <cstdlib>
#include <optional>

duo::Result<void> calibrate(char** argv) {
  DUO_TRY_ASSIGN(const duo::Board board, duo::parse_board(argv[3], std::atof(argv[4]) / 1000));
  DUO_TRY_ASSIGN(duo::BoardPictures pictures, duo::BoardPictures::open(argv[1], argv[2]));
  std::optional<duo::Calibrator> calibrator;
  duo::Pair pair;
  std::string name;
  while (true) {
    DUO_TRY_ASSIGN(const bool more, pictures.next(pair, name));
    if (!more) break;
    if (!calibrator) calibrator.emplace(board, pair.left.pixels.size());
    DUO_TRY_ASSIGN(const duo::BoardView* view, calibrator->add(pair, name));
    std::printf("%s: %zu and %zu corners\n", name.c_str(), view->left.size(), view->right.size());
  }
  if (!calibrator) return duo::Error{duo::ErrorCode::kBadInput, "no pictures"};
  DUO_TRY_ASSIGN(const duo::Calibration calibration, calibrator->solve());
  for (const std::string& warning : calibration.warnings) std::printf("warning: %s\n", warning.c_str());
  std::printf("baseline %.1f mm, corners within %.2f px\n", 1000 * calibration.rig.baseline_m(),
              calibration.rig.reprojection_rms_px);
  return duo::save_rig(calibration.rig, argv[5]);
}

int main(int argc, char** argv) {
  if (argc != 6) return std::fprintf(stderr, "calibrate_a_rig LEFT RIGHT BOARD SQUARE_MM RIG.json\n"), 2;
  const auto done = calibrate(argv);
  if (!done) std::fprintf(stderr, "%s\n", done.error().what.c_str());
  return done ? 0 : 1;
}
