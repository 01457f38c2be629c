// SPDX-License-Identifier: MIT
// Common to the parts of the Python module: a part binds its types in a source of its own, in this order. A program's
// edge: names, arrays and None become types and values here, and only here.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "logs/airframe_file.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace python {

namespace py = pybind11;
using pinnquad::logs::NamedAirframe;
using Triple = std::array<double, 3>;

void bind_errors(py::module_& module);
void bind_status(py::module_& module);
void bind_airframes(py::module_& module);
void bind_flights(py::module_& module);
void bind_simulators(py::module_& module);
void bind_vehicles(py::module_& module);
void bind_models(py::module_& module);
void bind_verdicts(py::module_& module);
void bind_training(py::module_& module);
void bind_conversion(py::module_& module);
void bind_identification(py::module_& module);

/// Throws pinnquad.Error of Python.
[[noreturn]] void refuse(const std::string& text);
/// The exception types pinnquad.Error and pinnquad.FlightEnded.
py::handle error_type();
py::handle flight_ended_type();

/// Throws ValueError: "no pilot named 'icarus'; known: random, hover".
template <class Names>
[[noreturn]] void refuse_name(const char* what, const std::string& name, const Names& known) {
  std::string text = "no " + std::string(what) + " named '" + pinnquad::printable(name) + "'; known: ";
  bool first = true;
  for (const auto& one : known) {
    text += std::string(first ? "" : ", ") + one;
    first = false;
  }
  throw py::value_error(text);
}

/// An argument, or ValueError: finite, and not below `least`.
double checked(const char* name, double value, double least);
const Triple& checked(const char* name, const Triple& values);

/// An Airframe, or the name of one, or the path of its file. Throws TypeError and what chosen_airframe() throws.
NamedAirframe airframe_of(py::handle given);
/// A Dataset, a Flight, or a sequence of flights. A dataset is not copied.
std::shared_ptr<const pinnquad::Dataset> dataset_of(py::handle given);

/// Numbers as a C-contiguous array of float32 or float64: `given` itself where it is one, else a copy, with the columns
/// `names` of a DataFrame or a structured array. Throws TypeError and ValueError, one line.
py::array plain_array(const char* what, const py::object& given, const std::vector<std::string>& names = {});
/// The same in float64.
py::array_t<double> doubles(const char* what, const py::object& given, const std::vector<std::string>& names = {});

inline Triple triple(const pinnquad::Vector3<double>& v) { return {v[0], v[1], v[2]}; }

/// Rewrites what pybind11 documents of every function, so that inspect.signature() and help() show its arguments.
void give_text_signatures(const py::module_& module);

/// Makes `Type.__new__(Type)` a TypeError, and a pickle of a type that says no other: Python's own way to one would end
/// the interpreter. `Type(...)` is as before.
void refuse_new(py::handle type);

template <std::size_t Count>
py::array_t<double> array_of(const std::array<double, Count>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(Count), numbers.data());  // a copy
}
inline py::array_t<double> array_of(const pinnquad::Vector3<double>& v) { return array_of(triple(v)); }

/// Numbers where they lie, for as long as `owner` lives; read-only.
py::array view_of(const double* numbers, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                  py::handle owner);

/// Numbers of a row by a name: where they stand in it, and how many they are.
struct RowPart {
  const char* name;
  py::ssize_t first, count;
  const char* doc;
};
/// They of `rows` rows that lie `row_bytes` apart, for as long as `owner` lives; `first_row` may be null without rows.
template <class Number>
py::array part_of_rows(Number* first_row, std::size_t rows, std::size_t row_bytes, const RowPart& part,
                       const py::object& owner) {
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(rows)}, strides = {static_cast<py::ssize_t>(row_bytes)};
  if (part.count > 1) {
    shape.push_back(part.count);
    strides.push_back(static_cast<py::ssize_t>(sizeof(double)));
  }
  Number* const numbers = rows == 0 ? nullptr : first_row + part.first;
  if constexpr (std::is_const_v<Number>) {
    return view_of(numbers, shape, strides, owner);
  } else {
    return py::array(py::dtype::of<double>(), shape, strides, numbers, owner);
  }
}

/// Looks for Ctrl-C twenty times a second, from a thread that has let go of the GIL.
class SignalWatch {
 public:
  /// Throws KeyboardInterrupt.
  void look() {
    if (Clock::now() < next_) return;
    next_ = Clock::now() + std::chrono::milliseconds(50);
    const py::gil_scoped_acquire with_gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(50);
};

/// Pickles by a state and what makes an object of it. `__new__` alone is refused: pybind11 would read an object that
/// nobody made.
template <class Class, class StateOf, class OfState>
void pickled(Class& bound, const StateOf& state_of, const OfState& of_state) {
  const std::string name = py::str(bound.attr("__name__"));
  bound.def_static("_of_state", of_state);
  bound.def("__reduce__", [state_of, name](const py::object& self) {
    return py::make_tuple(py::module_::import("pinnquad.pickles").attr("restored"),
                          py::make_tuple(name, state_of(self)));
  });
  refuse_new(bound);
}

/// Marks an object as in use by a thread without the GIL; looked at and set only by who holds it.
class Busy {
 public:
  explicit Busy(bool& flag) : flag_(flag) { flag_ = true; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;
  ~Busy() { flag_ = false; }

 private:
  bool& flag_;
};

}  // namespace python
