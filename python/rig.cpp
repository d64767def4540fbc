// Rig and cameras.
#include <algorithm>

#include "binding.h"

namespace duo::python {
namespace {

using Matrix = py::array_t<double>;

Matrix matrix_of(const Mat3& m) {
  Matrix out({3, 3});
  std::copy(m.m.begin(), m.m.end(), out.mutable_data());
  return out;
}
Matrix vector_of(Vec3 v) {
  Matrix out(3);
  double* p = out.mutable_data();
  p[0] = v.x, p[1] = v.y, p[2] = v.z;
  return out;
}
Matrix k_of(double fx, double fy, double cx, double cy) { return matrix_of({{fx, 0, cx, 0, fy, cy, 0, 0, 1}}); }
std::pair<int, int> pair_of(Size size) { return {size.width, size.height}; }

}  // namespace

std::optional<Rig> rig_of(const py::object& rig) {
  if (rig.is_none()) return std::nullopt;
  if (py::isinstance<Rig>(rig)) return rig.cast<Rig>();
  return value(load_rig(path_of(rig, "rig")));
}

void add_rig(py::module_& module) {
  py::class_<Camera>(module, "Camera", "A pinhole camera with a lens. Units: px; the centre of the top left pixel is (0, 0).")
      .def_property_readonly(
          "size", [](const Camera& c) { return pair_of(c.size); }, "(width, height), px")
      .def_property_readonly(
          "K", [](const Camera& c) { return k_of(c.fx_px, c.fy_px, c.cx_px, c.cy_px); }, "3x3: focal lengths and centre, px")
      .def_property_readonly(
          "distortion", [](const Camera& c) { return py::array_t<double>(c.distortion.size(), c.distortion.data()); },
          "8 numbers in OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6");
  py::class_<Rig>(module, "Rig", "Two cameras fixed to each other: what calibrate() finds and a rig file holds.")
      .def_readonly("left", &Rig::left)
      .def_readonly("right", &Rig::right)
      .def_property_readonly(
          "R", [](const Rig& rig) { return matrix_of(rig.right_from_left.rotation); }, "3x3: p_right = R p_left + t_m")
      .def_property_readonly(
          "t_m", [](const Rig& rig) { return vector_of(rig.right_from_left.t_m); }, "3 numbers, metres")
      .def_property_readonly("baseline_m", &Rig::baseline_m, "Distance of the cameras, metres")
      .def_readonly("metric", &Rig::metric, "False where the length of the baseline is a guess, and so is every distance")
      .def_readonly("reprojection_rms_px", &Rig::reprojection_rms_px, "How well the calibration fitted; 0 = unknown")
      .def(
          "save", [](const Rig& rig, const std::filesystem::path& path) { check(save_rig(rig, path)); }, py::arg("path"),
          "Writes Duoptic's JSON, which load_rig() and the tool read.")
      .def("__repr__", [](const Rig& rig) {
        const Size size = rig.left.size;
        return py::str("<duoptic.Rig {}x{}, baseline {:.4f} m>").format(size.width, size.height, rig.baseline_m());
      });
  module.def(
      "load_rig", [](const std::filesystem::path& path) { return value(load_rig(path)); }, py::arg("path"),
      "Reads a rig: Duoptic's JSON, OpenCV's YAML or JSON; `duoptic rig import` makes it of other files.\n\n"
      "Errors: duoptic.Error where it is missing, broken, or no rig.");
  py::class_<Rectified>(module, "Pinhole",
                        "The camera that color, depth and disparity of a frame are of: rectified, without distortion.")
      .def_property_readonly(
          "size", [](const Rectified& r) { return pair_of(r.size); }, "(width, height), px")
      .def_property_readonly(
          "K", [](const Rectified& r) { return k_of(r.focal_px, r.focal_px, r.cx_px, r.cy_px); }, "3x3, px")
      .def_readonly("focal_px", &Rectified::focal_px)
      .def_readonly("baseline_m", &Rectified::baseline_m)
      .def_property_readonly(
          "rig_from_left", [](const Rectified& r) { return matrix_of(r.rig_from_left); },
          "3x3: turns the raw left camera's axes to the rig frame's, in which all points are");
}

}  // namespace duo::python
