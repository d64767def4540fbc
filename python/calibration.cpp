// A rig from pictures of a board.
#include <algorithm>
#include <array>

#include "binding.h"
#include "duoptic/calibrate.h"

namespace duo::python {
namespace {

struct Calibrated {
  Calibration found;
  int pairs = 0;
  std::array<double, 2> coverage = {};
};

Calibrated calibrate(const std::filesystem::path& left, const py::object& second, const std::string& board_name,
                     double square_mm) {
  const std::filesystem::path right = path_of(second, "right");
  const Board board = value(parse_board(board_name, square_mm / 1000));
  BoardPictures pictures = value(BoardPictures::open(left, right));
  std::optional<Calibrator> calibrator;
  Pair pair;
  std::string name;
  while (true) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const py::gil_scoped_release others_go_on;
    if (!value(pictures.next(pair, name))) break;
    if (!calibrator) calibrator.emplace(board, pair.left.pixels.size());
    value(calibrator->add(pair, name));
  }
  if (!calibrator) refuse("cannot calibrate: " + left.string() + " has no pictures");
  const py::gil_scoped_release others_go_on;
  return {value(calibrator->solve()), calibrator->pairs(), {calibrator->coverage(0), calibrator->coverage(1)}};
}

}  // namespace

void add_calibration(py::module_& module) {
  py::class_<Calibrated>(module, "Calibration", "A rig, and how far it can be trusted.")
      .def_property_readonly("rig", [](const Calibrated& c) { return c.found.rig; })
      .def_property_readonly(
          "warnings", [](const Calibrated& c) { return c.found.warnings; },
          "What to know before trusting it, a line each; none = good")
      .def_readonly("pairs", &Calibrated::pairs, "Pairs that were looked at")
      .def_property_readonly(
          "used",
          [](const Calibrated& c) {
            return std::count_if(c.found.views.begin(), c.found.views.end(), [](const BoardView& view) { return view.used; });
          },
          "Pairs that the rig was found from")
      .def_readonly("coverage", &Calibrated::coverage, "Share of the left and of the right picture that had corners, 0 .. 1");
  module.def(
      "calibrate", &calibrate, py::arg("left"), py::arg("right") = py::none(), py::kw_only(), py::arg("board"),
      py::arg("square_mm"),
      "A Calibration from pictures of a board: two folders or two videos, or one folder with both. board: 'charuco:9x6'\n"
      "(squares) or 'chessboard:9x6' (inner corners); square_mm: side of a square, as measured on the print.\n\n"
      "Errors: duoptic.Error says what is missing or wrong: too few views, all of one pose, another board.");
}

}  // namespace duo::python
