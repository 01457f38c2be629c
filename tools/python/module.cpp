// SPDX-License-Identifier: MIT
// The module pinnquad._core: its parts, and how errors of the library become Python's.
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "command_line/build_facts.hpp"
#include "command_line/in_words.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/version.hpp"
#include "python/bindings.hpp"

namespace python {

namespace {

PyObject* error = nullptr;  ///< live as long as the module
PyObject* flight_ended = nullptr;

}  // namespace

py::handle error_type() { return error; }
py::handle flight_ended_type() { return flight_ended; }

void refuse(const std::string& text) {
  PyErr_SetString(error, text.c_str());
  throw py::error_already_set();
}

double checked(const char* name, double value, double least) {
  if (!(value >= least) || !pinnquad::is_finite(value)) {
    throw py::value_error(programs::in_words("%s must be a finite number not below %g", name, least));
  }
  return value;
}

const Triple& checked(const char* name, const Triple& values) {
  for (const double value : values) {
    if (!pinnquad::is_finite(value)) throw py::value_error(std::string(name) + " must be three finite numbers");
  }
  return values;
}

void refuse_new(py::handle type) {
  auto* const bound = reinterpret_cast<PyTypeObject*>(type.ptr());
  const py::cpp_function refused([](const py::args&, const py::kwargs&) {
    throw py::type_error("call the class: an object is not made by __new__ alone");
  });
  const auto method = py::reinterpret_steal<py::object>(PyStaticMethod_New(refused.ptr()));
  PyDict_SetItemString(bound->tp_dict, "__new__", method.ptr());  // what a call of the class uses stays
  if (PyDict_GetItemString(bound->tp_dict, "__reduce__") == nullptr) {
    const std::string text = std::string(bound->tp_name) + " is not pickled";
    const py::cpp_function unpickled([text](const py::args&) { throw py::type_error(text); }, py::is_method(type));
    PyDict_SetItemString(bound->tp_dict, "__reduce__", unpickled.ptr());
  }
  PyType_Modified(bound);
}

py::array plain_array(const char* what, const py::object& given, const std::vector<std::string>& names) {
  if (Py_TYPE(given.ptr()) == py::detail::npy_api::get().PyArray_Type_) {
    const auto array = py::reinterpret_borrow<py::array>(given);
    const bool plain = py::isinstance<py::array_t<double>>(array) || py::isinstance<py::array_t<float>>(array);
    if (plain && (array.flags() & py::array::c_style) != 0) return array;
  }
  return py::module_::import("pinnquad.arrays").attr("plain")(what, given, names).cast<py::array>();
}

py::array_t<double> doubles(const char* what, const py::object& given, const std::vector<std::string>& names) {
  return py::array_t<double, py::array::c_style | py::array::forcecast>(plain_array(what, given, names));
}

py::array view_of(const double* numbers, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                  py::handle owner) {
  py::array array(py::dtype::of<double>(), std::move(shape), std::move(strides), numbers, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

void bind_errors(py::module_& module) {
  error = PyErr_NewExceptionWithDoc("pinnquad.Error",
                                    "What the library refuses: a file that is not what it should be, a block, a "
                                    "Status that is not ok. One line.",
                                    nullptr, nullptr);
  module.add_object("Error", error);
  flight_ended = PyErr_NewExceptionWithDoc("pinnquad.FlightEnded",
                                           "The flight has ended: the ground, or a step that cannot be calculated. "
                                           "Attributes: time_s, altitude_m, position_m\n"
                                           "and velocity_m_s (NED), reason. The recording up to there is kept.",
                                           error, nullptr);
  module.add_object("FlightEnded", flight_ended);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const pinnquad::InputError& refused) {
      PyErr_SetString(error, refused.what());
    } catch (const pinnquad::OutputError& refused) {
      PyErr_SetString(PyExc_OSError, refused.what());
    } catch (const std::filesystem::filesystem_error& refused) {
      PyErr_SetString(PyExc_OSError, refused.what());
    }
  });
}

void bind_status(py::module_& module) {
  py::list values;
  for (int i = 0; i < pinnquad::status_count; ++i) {
    const std::string word = to_string(static_cast<pinnquad::Status>(i));
    if (word.find(' ') == std::string::npos) values.append(py::make_tuple(word, i));  // "unknown status": no enumerator
  }
  const py::object made = py::module_::import("enum").attr("IntEnum")("Status", values, py::arg("module") = "pinnquad");
  made.attr("__doc__") = "The outcome of a call of the library, vehicle by vehicle or row by row.";
  module.attr("Status") = made;
}

}  // namespace python

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = PINNQUAD_VERSION;
  module.attr("instruction_set") = programs::instruction_set();
  python::bind_errors(module);
  python::bind_status(module);
  python::bind_airframes(module);
  python::bind_flights(module);
  python::bind_simulators(module);
  python::bind_vehicles(module);
  python::bind_models(module);
  python::bind_verdicts(module);
  python::bind_training(module);
  python::bind_conversion(module);
  python::bind_identification(module);
  python::give_text_signatures(module);
}
