// duoptic board: a calibration board to print.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "command.h"
#include "duoptic/board.h"
#include "duoptic/stdout.h"

namespace duo::app::board {
namespace {

constexpr char kFooter[] =
    "Print it at 100 % (\"actual size\"), check the ruler on it, and tape it flat onto something stiff. PDF and SVG are "
    "vector\n"
    "graphics; a PNG has 254 dots per inch. ChArUco boards are OpenCV's (4.6 and later) with the markers of\n"
    "DICT_4X4, 5X5 or 6X6; unlike a chessboard they may be cut by the picture's border. How to go on: docs/calibrate.md.\n\n"
    "Examples:\n"
    "  duoptic board -o board.pdf\n"
    "  duoptic board -o board.pdf --board charuco:9x6 --paper a3 --square-mm 40";

struct Options {
  std::string output, board = "chessboard:9x6", paper = "a4";
  std::optional<double> square_mm;
};

Result<Exit> run(const Options& options) {
  DUO_TRY_ASSIGN(const Paper paper, parse_paper(options.paper));
  DUO_TRY_ASSIGN(const Board board, options.square_mm ? parse_board(options.board, *options.square_mm / 1000)
                                                      : largest_board(options.board, paper));
  DUO_TRY(write_board(board, paper, options.output));
  const double square_mm = 1000 * board.square_m;
  const std::string said = fmt::format(
      "{}: {} with squares of {:.4g} mm on {}; print it at 100 % and check the ruler, then\n"
      "  duoptic calibrate left.avi right.avi --board {} --square-mm {:.4g} -o rig.json\n",
      options.output, board.name(), square_mm, paper.name, board.name(), square_mm);
  is_stdout(options.output) ? put_on_stderr(said) : fmt::print("{}", said);
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("board", "A calibration board to print, in true scale");
  const auto options = std::make_shared<Options>();
  sub->add_option("-o,--output", options->output, "File that ends with .pdf, .svg or .png; - is stdout, a PDF")
      ->type_name("FILE")
      ->required();
  sub->add_option("--board", options->board, "chessboard:9x6 (inner corners) or charuco:9x6 (squares)")->capture_default_str();
  sub->add_option("--square-mm", options->square_mm, "Side of a square; without it the largest whole one that fits")
      ->check(within(1.0, 1000.0));
  sub->add_option("--paper", options->paper, "a4, letter or a3")->capture_default_str();
  sub->footer(kFooter);
  return {sub, [options] { return run(*options); }};
}

}  // namespace duo::app::board
