// What the files of the Python module share. The module is the library's API with keyword arguments: nothing is computed here.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "duoptic/pipeline.h"

namespace duo::python {

namespace py = pybind11;

/// Becomes duoptic.Error, whose text is the line that the tool prints.
struct Failure final : std::exception {
  explicit Failure(Error of) : error(std::move(of)) {}
  const char* what() const noexcept override { return error.what.c_str(); }
  Error error;
};

inline void check(const Result<void>& done) {
  if (!done) throw Failure(done.error());
}
template <class T>
T value(Result<T> made) {
  if (!made) throw Failure(made.error());
  return std::move(*made);
}
[[noreturn]] inline void refuse(std::string why) { throw Failure({ErrorCode::kBadInput, std::move(why)}); }

/// One instant as Python keeps it: all of it is shared and constant, so it stays what it is while later ones are made.
struct Instant {
  std::shared_ptr<const Frame> frame;
  std::shared_ptr<const Pair> pair;
  std::optional<Rectified> rectified;
  std::vector<Person> people;
  std::int64_t number = 0;
  double t_s = 0;
};

/// A path, or nothing for None.
///
/// Errors  no path
std::filesystem::path path_of(const py::object& path, const char* name);

/// None, a duoptic.Rig, or the path of a rig file.
std::optional<Rig> rig_of(const py::object& rig);

/// Everything of the engine that can be chosen by keyword.
struct MatchOptions {
  std::string engine, matcher, preset;
  int threads = 0;
  std::vector<std::pair<std::string, double>> parameters;
  std::optional<int> max_disparity;
  std::optional<double> near_m;
  bool fill = false;
  std::optional<std::vector<std::string>> maps;

  /// `keywords` loses those that are options of the engine; what is left is the caller's.
  ///
  /// Errors  a value of another type, or out of range
  static MatchOptions take_from(py::dict& keywords);
  /// The setup but for size and rows.
  Setup setup(const std::optional<Rig>& rig) const;
};

/// Takes the keyword `name` out of `keywords`.
template <class T>
T take(py::dict& keywords, const char* name, T otherwise) {
  if (!keywords.contains(name)) return otherwise;
  const py::object given = keywords[name];
  PyDict_DelItemString(keywords.ptr(), name);
  try {
    return given.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + " cannot be " + py::repr(given).cast<std::string>());
  }
}
/// Errors  keywords that nobody took
void all_taken(const py::dict& keywords, const std::string& function);

void add_rig(py::module_& module);
void add_people(py::module_& module);
void add_frame(py::module_& module);
void add_frames(py::module_& module);
void add_engine(py::module_& module);
void add_calibration(py::module_& module);

}  // namespace duo::python
