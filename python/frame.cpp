// A frame as numpy arrays: maps are views of the frame's own memory, which lives as long as any of them.
#include <cmath>
#include <limits>

#include "binding.h"

namespace duo::python {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

const Instant& instant_of(const py::object& self) { return self.cast<const Instant&>(); }

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Memory of `owner`, H x W.
template <class T>
py::array view_of(const Image<T>& image, const char* name, const py::object& owner) {
  if (image.empty()) refuse(std::string("the frame has no ") + name + "; ask for it with maps=[...] when it is opened");
  constexpr auto kBytes = static_cast<py::ssize_t>(sizeof(T));
  return read_only(
      py::array(py::dtype::of<T>(), {image.height(), image.width()}, {image.stride() * kBytes, kBytes}, image.row(0), owner));
}
/// H x W x 3.
py::array view_of(const Image<Rgb8>& image, const char* name, const py::object& owner) {
  if (image.empty()) refuse(std::string("the frame has no ") + name + "; ask for it with maps=[...] when it is opened");
  return read_only(py::array(py::dtype::of<std::uint8_t>(), {image.height(), image.width(), 3},
                             {image.stride() * py::ssize_t{3}, py::ssize_t{3}, py::ssize_t{1}},
                             reinterpret_cast<const std::uint8_t*>(image.row(0)), owner));
}

/// float32 of the size of `from`, value by value.
template <class T, class Value>
py::array_t<float> made_of(const Image<T>& from, const char* name, Value&& value_of) {
  if (from.empty()) refuse(std::string("the frame has no ") + name + "; ask for it with maps=[...] when it is opened");
  py::array_t<float> out({from.height(), from.width()});
  float* to = out.mutable_data();
  const py::gil_scoped_release others_go_on;
  for (int y = 0; y < from.height(); ++y)
    for (int x = 0; x < from.width(); ++x) *to++ = value_of(from.at(y, x));
  return out;
}

py::array_t<float> points_of(const Instant& instant) {
  const Image<std::uint16_t>& d_q4 = instant.frame->disparity.d_q4;
  if (!instant.rectified) refuse("points in metres need a rig; give rig");
  if (d_q4.empty()) refuse("the frame has no disparity; ask for it with maps=[...] when it is opened");
  py::array_t<float> out({d_q4.height(), d_q4.width(), 3});
  float* to = out.mutable_data();
  const py::gil_scoped_release others_go_on;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x, to += 3) {
      const std::uint16_t d = d_q4.at(y, x);
      to[0] = to[1] = to[2] = kNaN;
      if (d == Disparity::kNone || d == 0) continue;
      const Vec3 p = instant.rectified->triangulate({static_cast<double>(x), static_cast<double>(y)}, d / 16.0);
      to[0] = static_cast<float>(p.x), to[1] = static_cast<float>(p.y), to[2] = static_cast<float>(p.z);
    }
  return out;
}

}  // namespace

void add_frame(py::module_& module) {
  py::class_<Instant>(module, "Frame",
                      "All that is known of one instant. It stays as it is while later frames are made.\n\n"
                      "Maps of whole numbers are read-only numpy views of the frame's memory, without a copy, H x W of the\n"
                      "rectified left picture; depth_m, disparity and points are made of them when they are asked for.")
      .def_readonly("number", &Instant::number, "From 0, of the source")
      .def_readonly("t_s", &Instant::t_s, "Seconds since the source's first picture")
      .def_readonly("people", &Instant::people, "list of Person")
      .def_readonly("camera", &Instant::rectified, "Pinhole of the maps; None without a rig")
      .def_property_readonly(
          "skew_s", [](const Instant& i) { return static_cast<double>(i.frame->skew_ns) * 1e-9; },
          "How much later than the left one the right picture was taken")
      .def_property_readonly(
          "depth_mm", [](const py::object& self) { return view_of(instant_of(self).frame->depth_mm, "depth", self); },
          "uint16 (H, W): z in the rig frame, mm; 0 = unknown")
      .def_property_readonly(
          "disparity_q4",
          [](const py::object& self) { return view_of(instant_of(self).frame->disparity.d_q4, "disparity", self); },
          "uint16 (H, W): x_left - x_right in 1/16 px; 65535 = unknown")
      .def_property_readonly(
          "origin", [](const py::object& self) { return view_of(instant_of(self).frame->disparity.origin, "disparity", self); },
          "uint8 (H, W): where a disparity came from: 0 none, 1 measured, 2 filled")
      .def_property_readonly(
          "confidence", [](const py::object& self) { return view_of(instant_of(self).frame->confidence, "confidence", self); },
          "uint8 (H, W): 1 doubtful .. 255 sure where measured, else 0")
      .def_property_readonly(
          "color", [](const py::object& self) { return view_of(instant_of(self).frame->color, "color", self); },
          "uint8 (H, W, 3): the rectified left picture, RGB")
      .def_property_readonly(
          "left", [](const py::object& self) { return view_of(instant_of(self).frame->left, "views", self); },
          "uint8 (H, W): the rectified left picture as the matcher saw it")
      .def_property_readonly(
          "right", [](const py::object& self) { return view_of(instant_of(self).frame->right, "views", self); },
          "uint8 (H, W): the rectified right picture as the matcher saw it")
      .def_property_readonly(
          "raw_left", [](const py::object& self) { return view_of(instant_of(self).pair->left.pixels, "picture", self); },
          "uint8 (height, width, 3): as the left camera took it, RGB")
      .def_property_readonly(
          "raw_right", [](const py::object& self) { return view_of(instant_of(self).pair->right.pixels, "picture", self); },
          "uint8 (height, width, 3): as the right camera took it, RGB")
      .def_property_readonly(
          "depth_m",
          [](const Instant& i) {
            return made_of(i.frame->depth_mm, "depth",
                           [](std::uint16_t mm) { return mm == 0 ? kNaN : static_cast<float>(mm) / 1000; });
          },
          "float32 (H, W): depth_mm in metres; NaN = unknown")
      .def_property_readonly(
          "disparity",
          [](const Instant& i) {
            return made_of(i.frame->disparity.d_q4, "disparity",
                           [](std::uint16_t d) { return d == Disparity::kNone ? kNaN : static_cast<float>(d) / 16; });
          },
          "float32 (H, W): x_left - x_right, px; NaN = unknown")
      .def_property_readonly("points", points_of,
                             "float32 (H, W, 3): x right, y down, z forward in the rig frame, metres; NaN = unknown");
}

}  // namespace duo::python
