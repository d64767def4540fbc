// Persons and joints.
#include <limits>

#include "binding.h"

namespace duo::python {
namespace {

/// A joint with the name that its skeleton gives it.
struct NamedJoint {
  std::string_view name;
  Joint joint;
};

const char* text_of(JointState state) {
  constexpr const char* kTexts[] = {"seen", "inferred", "lost"};
  return kTexts[static_cast<int>(state)];
}
const char* text_of(Presence presence) {
  constexpr const char* kTexts[] = {"seen", "hidden", "lost"};
  return kTexts[static_cast<int>(presence)];
}

std::tuple<double, double, double> tuple_of(Vec3 v) { return {v.x, v.y, v.z}; }

py::dict joints_of(const Person& person) {
  py::dict out;
  for (std::size_t j = 0; j < person.count(); ++j) {
    const std::string_view name = person.skeleton->joints[j].name;
    out[py::str(name.data(), name.size())] = NamedJoint{name, person.joints[j]};
  }
  return out;
}

py::array_t<double> places_of(const Person& person) {
  py::array_t<double> out({static_cast<py::ssize_t>(person.count()), py::ssize_t{3}});
  double* p = out.mutable_data();
  for (std::size_t j = 0; j < person.count(); ++j, p += 3) {
    const Joint& joint = person.joints[j];
    const double none = std::numeric_limits<double>::quiet_NaN();
    const Vec3 at = joint.state == JointState::kLost ? Vec3{none, none, none} : joint.p_in_rig_m;
    p[0] = at.x, p[1] = at.y, p[2] = at.z;
  }
  return out;
}

py::array_t<double> matrix_of(const Covariance3& c) {
  py::array_t<double> out({3, 3});
  const double values[] = {c.xx, c.xy, c.xz, c.xy, c.yy, c.yz, c.xz, c.yz, c.zz};
  std::copy(std::begin(values), std::end(values), out.mutable_data());
  return out;
}

}  // namespace

void add_people(py::module_& module) {
  py::class_<NamedJoint>(module, "Joint",
                         "One joint at one instant. Places are metres in the rig frame: x right, y down, z forward.")
      .def_property_readonly("name", [](const NamedJoint& j) { return j.name; })
      .def_property_readonly(
          "state", [](const NamedJoint& j) { return text_of(j.joint.state); },
          "'seen'; 'inferred': hidden, predicted from what is known of the body; 'lost': the place means nothing")
      .def_property_readonly(
          "p_m", [](const NamedJoint& j) { return tuple_of(j.joint.p_in_rig_m); }, "(x, y, z) of the centre inside the body, m")
      .def_property_readonly(
          "v_m_s", [](const NamedJoint& j) { return tuple_of(j.joint.v_in_rig_m_s); }, "Velocity (x, y, z), m/s")
      .def_property_readonly(
          "sigma_m", [](const NamedJoint& j) { return j.joint.sigma_m(); },
          "One standard deviation of the distance from the truth, m")
      .def_property_readonly(
          "covariance_m2", [](const NamedJoint& j) { return matrix_of(j.joint.cov_m2); }, "3x3, m^2")
      .def_property_readonly(
          "confidence", [](const NamedJoint& j) { return j.joint.confidence; }, "0 .. 1")
      .def_property_readonly(
          "uv_px", [](const NamedJoint& j) { return std::pair(j.joint.u_px, j.joint.v_px); },
          "(u, v) where it projects in the raw left picture, px")
      .def("__repr__", [](const NamedJoint& j) {
        const Vec3 p = j.joint.p_in_rig_m;
        return py::str("<duoptic.Joint {} {} ({:.3f}, {:.3f}, {:.3f}) m>")
            .format(j.name, text_of(j.joint.state), p.x, p.y, p.z);
      });
  py::class_<Person>(module, "Person", "One person at one instant.")
      .def_readonly("id", &Person::id, "From 1; the same while the person is tracked")
      .def_property_readonly(
          "skeleton", [](const Person& p) { return p.skeleton == nullptr ? std::string_view() : p.skeleton->name; },
          "'body', 'body_hands', 'right_arm' or 'left_arm'")
      .def_property_readonly(
          "presence", [](const Person& p) { return text_of(p.presence); }, "'seen', 'hidden' (no joint was measured) or 'lost'")
      .def_readonly("confidence", &Person::confidence, "0 .. 1")
      .def_property_readonly(
          "box_px", [](const Person& p) { return std::tuple(p.box_px.x, p.box_px.y, p.box_px.width, p.box_px.height); },
          "(x, y, width, height) around the joints that are not lost, raw left picture")
      .def_property_readonly("joints", joints_of, "dict of name to Joint, parents first")
      .def_property_readonly("places_m", places_of, "float64 (joints, 3), metres in the rig frame; NaN where lost")
      .def(
          "pinch_m",
          [](const Person& p, const std::string& side) -> std::optional<std::pair<double, double>> {
            if (side != "left" && side != "right") refuse("pinch_m: the side is neither 'left' nor 'right'");
            const auto pinch = pinch_of(p, side == "left" ? Side::kLeft : Side::kRight);
            if (!pinch) return std::nullopt;
            return std::pair(pinch->distance_m, pinch->sigma_m);
          },
          py::arg("side"),
          "(distance, one standard deviation) between the tips of thumb and index finger of the 'left' or 'right' hand, m;\n"
          "None where a tip is lost or neither is seen")
      .def("__repr__", [](const Person& p) { return py::str("<duoptic.Person {} {}>").format(p.id, text_of(p.presence)); });
}

}  // namespace duo::python
