// import duoptic: where the parts of the module meet, and errors become exceptions.
#include "binding.h"
#include "duoptic/version.h"

namespace duo::python {
namespace {

const char* name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadInput:
      return "bad input";
    case ErrorCode::kNotFound:
      return "not found";
    case ErrorCode::kUnsupported:
      return "unsupported";
    case ErrorCode::kWriteFailed:
      return "write failed";
    case ErrorCode::kDeviceLost:
      return "device lost";
    case ErrorCode::kExhausted:
      return "exhausted";
  }
  return "";
}

void add_error(py::module_& module) {
  static PyObject* error_class = PyErr_NewExceptionWithDoc(
      "duoptic.Error",
      "What cannot be done: one line that says what was tried, on what, why it failed and what to do.\n\n"
      "code: 'bad input', 'not found', 'unsupported', 'write failed', 'device lost' or 'exhausted'.",
      PyExc_RuntimeError, nullptr);
  module.attr("Error") = py::handle(error_class);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Failure& failure) {
      const py::object line = py::reinterpret_steal<py::object>(
          PyUnicode_DecodeUTF8(failure.error.what.data(), static_cast<Py_ssize_t>(failure.error.what.size()), "replace"));
      py::object error = py::handle(error_class)(line);
      error.attr("code") = name_of(failure.error.code);
      PyErr_SetObject(error_class, error.ptr());
    }
  });
}

}  // namespace

void all_taken(const py::dict& keywords, const std::string& function) {
  if (keywords.empty()) return;
  const std::string name = (*keywords.begin()).first.cast<std::string>();
  throw py::type_error(function + "() got an unexpected keyword argument '" + name + "'");
}

std::filesystem::path path_of(const py::object& path, const char* name) {
  if (path.is_none()) return {};
  try {
    return path.cast<std::filesystem::path>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + " is no path: " + py::repr(path).cast<std::string>());
  }
}

}  // namespace duo::python

PYBIND11_MODULE(_duoptic, module) {
  using namespace duo::python;  // NOLINT
  module.attr("__version__") = duo::version();
  add_error(module);
  add_rig(module);
  add_people(module);
  add_frame(module);
  add_frames(module);
  add_engine(module);
  add_calibration(module);
  for (const char* name : {"Calibration", "Camera", "Engine", "Frame", "Frames", "Joint", "Person", "Pinhole", "Rig"})
    module.attr(name).attr("__module__") = "duoptic";
}
