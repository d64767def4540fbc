// Pictures for the example of calibration, where there are no cameras: six pairs of a drawn board.
//   draw_boards FOLDER
#include "duoptic/sink.h"
#include "tests/drawn_board.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const duo::Board board{.columns = 8, .rows = 6, .square_m = 0.03};
  const auto poses = duo::test::spread_poses(board);
  for (unsigned i = 0; i < 6; ++i) {
    const duo::Pair pair = duo::test::draw(board, duo::test::crooked_rig(), poses[i], i);
    for (const bool left : {true, false}) {
      const auto folder = std::filesystem::path(argv[1]) / (left ? "left" : "right");
      std::filesystem::create_directories(folder);
      if (!duo::write_png((left ? pair.left : pair.right).pixels, folder / (std::to_string(i) + ".png"))) return 1;
    }
  }
}
