// SPDX-License-Identifier: MIT
// Models of blocks: loaded, asked one motion or many.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/exported/run_time_batch.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "python/bindings.hpp"

namespace python {

namespace {

using namespace pinnquad;

std::shared_ptr<BlockModel> load(const std::filesystem::path& path) {
  return std::make_shared<BlockModel>(path.string());
}

/// Features as they are given: one motion or a row for each. Throws TypeError and ValueError, one line.
struct GivenFeatures {
  GivenFeatures(const BlockModel& model, const py::object& given)
      : array(plain_array("predict", given, model.feature_names())),
        features(model.features().size()),
        is_double(py::isinstance<py::array_t<double>>(array)) {
    const py::ssize_t dimensions = array.ndim();
    if (dimensions < 1 || dimensions > 2 || array.shape(dimensions - 1) != features) {
      throw py::value_error("predict: expected shape (" + std::to_string(features) + ",) or (rows, " +
                            std::to_string(features) + "), found " + py::str(array.attr("shape")).cast<std::string>());
    }
    rows = dimensions == 2 ? static_cast<std::size_t>(array.shape(0)) : 1;
  }

  py::array array;
  py::ssize_t features;
  bool is_double;
  std::size_t rows = 0;
};

/// The first that is not finite, among `count` numbers; count where all are.
template <class Number>
std::size_t first_not_finite(const Number* numbers, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_finite(numbers[i])) return i;
  }
  return count;
}

/// As the guard that flies says (TrainingGuard).
template <class Model, class Scalar>
Status guarded(const Model& model, const Scalar* x, const Scalar* u) {
  const auto size = static_cast<std::size_t>(model.features().size());
  if (first_not_finite(x, size) < size) return Status::not_finite;
  if (!model.inside_envelope(x)) return Status::outside_envelope;
  return first_not_finite(u, rotor_count) < rotor_count ? Status::output_not_finite : Status::ok;
}

/// Answers to rows in the model's own scalar. `statuses`: null where none are asked for, then every row is answered.
template <class Number, class Scalar>
void answer(const RunTimeRow<Scalar>& one, const Number* x, std::size_t rows, Scalar* u, std::uint8_t* statuses,
            SignalWatch& watch) {
  constexpr std::size_t most_at_once = 256, fewest_side_by_side = 6;
  const RunTimeModel<Scalar>& model = one.model();
  const auto size = static_cast<std::size_t>(model.features().size());
  const std::size_t at_once = std::min(most_at_once, rows);
  std::vector<Scalar> own(at_once * size), work(std::max(batch_workspace(model), one.workspace()));
  for (std::size_t first = 0; first < rows; first += at_once) {
    const std::size_t count = std::min(at_once, rows - first);
    const Number* const given = x + first * size;
    for (std::size_t i = 0; i < count * size; ++i) own[i] = static_cast<Scalar>(given[i]);
    Scalar* const commands = u + first * rotor_count;
    if (count < fewest_side_by_side) {
      for (std::size_t row = 0; row < count; ++row) {
        one.commands(own.data() + row * size, commands + row * rotor_count, work.data());
      }
    } else {
      commands_of_rows(model, own.data(), count, commands, work.data());
    }
    for (std::size_t row = 0; statuses != nullptr && row < count; ++row) {
      Scalar* const of_row = commands + row * rotor_count;
      const Status status = guarded(model, own.data() + row * size, of_row);
      statuses[first + row] = static_cast<std::uint8_t>(status);
      if (status != Status::ok) std::fill_n(of_row, rotor_count, std::numeric_limits<Scalar>::quiet_NaN());
    }
    watch.look();
  }
}

template <class Number>
void require_finite(const GivenFeatures& given) {
  const auto* x = static_cast<const Number*>(given.array.data());
  const auto size = static_cast<std::size_t>(given.features), count = given.rows * size;
  const std::size_t at = first_not_finite(x, count);
  if (at == count) return;
  throw py::value_error("predict: row " + std::to_string(at / size) + ", feature " + std::to_string(at % size) +
                        ": expected a finite number, found " + std::to_string(x[at]));
}

/// Commands as a DataFrame where the features are one.
py::object named_as(const py::object& features, py::object commands) {
  if (py::isinstance<py::array>(features) || !py::hasattr(features, "columns")) return commands;
  return py::module_::import("pinnquad.arrays").attr("commands_like")(features, commands);
}

/// Throws unless `out` has the shape of `commands` and holds their numbers.
void require_takes(const py::object& out, const py::array& commands) {
  const py::str shape(commands.attr("shape"));
  const std::string expected = "predict: out: expected an array of shape " + shape.cast<std::string>() +
                               ", float32 or float64, that may be written to, found ";
  if (!py::isinstance<py::array>(out)) throw py::type_error(expected + Py_TYPE(out.ptr())->tp_name);
  const auto given = py::reinterpret_borrow<py::array>(out);
  const bool fits = given.dtype().kind() == 'f' && given.itemsize() >= commands.itemsize() && given.itemsize() <= 8;
  if (fits && given.writeable() && given.attr("shape").equal(commands.attr("shape"))) return;
  throw py::value_error(expected + py::str(given.attr("shape")).cast<std::string>() + ", " +
                        py::str(given.dtype()).cast<std::string>() + (given.writeable() ? "" : ", read-only"));
}

py::object predict(const BlockModel& model, const py::object& features, bool guarded, const py::object& out) {
  const GivenFeatures given(model, features);
  if (!guarded) given.is_double ? require_finite<double>(given) : require_finite<float>(given);
  return model.with_row([&](const auto& one) -> py::object {
    using Scalar = std::remove_const_t<std::remove_pointer_t<decltype(one.model().parameters())>>;
    const auto rows = static_cast<py::ssize_t>(given.rows), rotors = static_cast<py::ssize_t>(rotor_count);
    const bool is_one = given.array.ndim() == 1;
    py::array_t<Scalar> commands(is_one ? std::vector<py::ssize_t>{rotors} : std::vector<py::ssize_t>{rows, rotors});
    if (!out.is_none()) require_takes(out, commands);
    py::array_t<std::uint8_t> statuses(guarded ? rows : 0);
    Scalar* const u = commands.mutable_data();
    std::uint8_t* const said = guarded ? statuses.mutable_data() : nullptr;
    const void* const x = given.array.data();
    {
      const py::gil_scoped_release without_gil;
      SignalWatch watch;
      given.is_double ? answer(one, static_cast<const double*>(x), given.rows, u, said, watch)
                      : answer(one, static_cast<const float*>(x), given.rows, u, said, watch);
    }
    if (!out.is_none()) {
      py::module_::import("numpy").attr("copyto")(out, commands);
      return out;
    }
    if (!guarded) return named_as(features, std::move(commands));
    return py::make_tuple(named_as(features, commands),
                          is_one ? py::module_::import("pinnquad").attr("Status")(said[0]) : py::object(statuses));
  });
}

// One motion of a plain array takes a shorter way, without pybind11, without memory of its own: that would be most of
// the time. What is anything else, or wrong, goes to predict() above, which has the words.

/// Numbers that one motion may work in on the stack, and parameters that take it microseconds, so that it may keep the
/// GIL.
constexpr std::size_t most_on_stack = 1024;
constexpr int most_parameters = 1 << 16;

PyTypeObject* model_type = nullptr;  ///< live as long as the module
PyObject* predict_of_any = nullptr;  ///< predict() as pybind11 calls it

/// NumPy's own description of these numbers.
template <class Number>
PyObject* numbers_type() {
  static PyObject* const type =
      py::detail::npy_api::get().PyArray_DescrFromType_(py::detail::npy_format_descriptor<Number>::value);
  return type;
}

/// The numbers of a plain array of one dimension, C-contiguous and with `flags` of NumPy; null for any other.
template <class Number>
Number* numbers_of(PyObject* given, py::ssize_t size, int flags = 0) {
  using Api = py::detail::npy_api;
  if (Py_TYPE(given) != Api::get().PyArray_Type_) return nullptr;
  const auto* const array = py::detail::array_proxy(given);
  flags |= Api::NPY_ARRAY_C_CONTIGUOUS_ | Api::NPY_ARRAY_ALIGNED_;
  const bool plain = array->nd == 1 && array->dimensions[0] == size && array->descr == numbers_type<Number>() &&
                     (array->flags & flags) == flags;
  return plain ? reinterpret_cast<Number*>(array->data) : nullptr;
}

/// False where a number is not finite.
template <class Number, class Scalar>
bool answer_one(const RunTimeRow<Scalar>& one, const Number* x, Scalar* u) {
  const auto size = static_cast<std::size_t>(one.model().features().size());
  if (first_not_finite(x, size) < size) return false;
  Scalar own[most_on_stack], work[most_on_stack];
  for (std::size_t i = 0; i < size; ++i) own[i] = static_cast<Scalar>(x[i]);
  one.commands(own, u, work);
  return true;
}

/// Commands, or null with no error of Python where this is not the way. `out` may be null.
template <class Scalar>
PyObject* predict_one(const RunTimeRow<Scalar>& one, PyObject* features, PyObject* out) {
  using Api = py::detail::npy_api;
  const py::ssize_t size = one.model().features().size();
  if (static_cast<std::size_t>(size) > most_on_stack || one.workspace() > most_on_stack ||
      one.model().network().parameter_count() > most_parameters) {
    return nullptr;
  }
  Scalar* const place = out == nullptr ? nullptr : numbers_of<Scalar>(out, rotor_count, Api::NPY_ARRAY_WRITEABLE_);
  if (out != nullptr && place == nullptr) return nullptr;
  Scalar u[rotor_count];
  if (const auto* const x = numbers_of<double>(features, size)) {
    if (!answer_one(one, x, u)) return nullptr;
  } else if (const auto* const single = numbers_of<float>(features, size)) {
    if (!answer_one(one, single, u)) return nullptr;
  } else {
    return nullptr;
  }
  if (out != nullptr) {
    std::copy_n(u, rotor_count, place);
    Py_INCREF(out);
    return out;
  }
  const Py_intptr_t shape[] = {rotor_count};
  Py_INCREF(numbers_type<Scalar>());  // which the array takes
  PyObject* const commands = Api::get().PyArray_NewFromDescr_(Api::get().PyArray_Type_, numbers_type<Scalar>(), 1,
                                                              shape, nullptr, nullptr, 0, nullptr);
  if (commands != nullptr) {
    std::copy_n(u, rotor_count, reinterpret_cast<Scalar*>(py::detail::array_proxy(commands)->data));
  }
  return commands;
}

/// Model.predict as Python calls it: `arguments` by place, then those named.
PyObject* called_predict(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  const Py_ssize_t named = names == nullptr ? 0 : PyTuple_GET_SIZE(names);
  const bool has_out = named == 1 && PyUnicode_CompareWithASCIIString(PyTuple_GET_ITEM(names, 0), "out") == 0;
  const void* const model = reinterpret_cast<py::detail::instance*>(self)->get_value_and_holder().value_ptr();
  if (count == 1 && (named == 0 || has_out) && Py_TYPE(self) == model_type && model != nullptr) {
    PyObject* const out = has_out && arguments[1] != Py_None ? arguments[1] : nullptr;
    PyObject* const commands = static_cast<const BlockModel*>(model)->with_row(
        [&](const auto& one) { return predict_one(one, arguments[0], out); });
    if (commands != nullptr || PyErr_Occurred() != nullptr) return commands;
  }
  try {
    std::vector<PyObject*> all = {self};
    all.insert(all.end(), arguments, arguments + count + named);
    return PyObject_Vectorcall(predict_of_any, all.data(), static_cast<std::size_t>(count) + 1, names);
  } catch (const std::bad_alloc&) {
    return PyErr_NoMemory();
  }
}

py::array_t<double> features_of(const BlockModel& model, const py::object& flights) {
  const std::shared_ptr<const Dataset> dataset = dataset_of(flights);
  const RowSet rows = all_rows(dataset->flights());
  const auto size = static_cast<std::size_t>(model.features().size());
  py::array_t<double> result({rows.size(), size});
  double* const x = result.mutable_data();
  const py::gil_scoped_release without_gil;
  SignalWatch watch;
  std::fill_n(x, rows.size() * size, not_a_number);
  model.answer(
      rows,
      [&](std::size_t row, const BlockModel::AnsweredRow& answered) {
        std::copy(answered.features.begin(), answered.features.end(), x + row * size);
        watch.look();
      },
      false);
  return result;
}

py::bytes bytes_of(const BlockModel& model) {
  return py::bytes(reinterpret_cast<const char*>(model.data()), model.size());
}

void save(const BlockModel& model, const std::filesystem::path& path) {
  AtomicFile file(path.string());
  file.stream().write(reinterpret_cast<const char*>(model.data()), static_cast<std::streamsize>(model.size()));
  file.commit();
}

}  // namespace

void bind_models(py::module_& module) {
  py::class_<BlockModel, std::shared_ptr<BlockModel>> model(
      module, "Model", "A model of any network and features, as its block describes it. It never changes.");
  model.def_static("load", &load, py::arg("path"), "The block that `pinnquad train` writes (model.block).")
      .def_static(
          "of_bytes",
          [](const py::bytes& bytes) { return std::make_shared<BlockModel>("bytes", static_cast<std::string>(bytes)); },
          py::arg("bytes"), "Of a block in memory.")
      .def(
          "predict",
          [](const BlockModel& self, const py::object& x, const py::object& out) {
            return predict(self, x, false, out);
          },
          py::arg("features"), py::kw_only(), py::arg("out") = py::none())
      .def(
          "predict_guarded",
          [](const BlockModel& self, const py::object& x) { return predict(self, x, true, py::none()); },
          py::arg("features"),
          "(commands, statuses) under the guard that flies: rows that it refuses are NaN, with their Status "
          "(not_finite,\n"
          "outside_envelope, output_not_finite) in place of ok.")
      .def("features", &features_of, py::arg("flights"),
           "Its features of each row of a Flight or a Dataset, rows x features; NaN where a window has no rows.")
      .def_property_readonly("feature_names", &BlockModel::feature_names)
      .def_property_readonly("name", &BlockModel::name)
      .def_property_readonly("airframe",
                             [](const BlockModel& self) {
                               return NamedAirframe{self.airframe_name(), self.airframe()};
                             })
      .def_property_readonly(
          "envelope",
          [](const BlockModel& self) {
            return py::make_tuple(py::array(py::cast(self.envelope_lower())),
                                  py::array(py::cast(self.envelope_upper())));
          },
          "The guard's (lower, upper) of each feature.")
      .def("save", &save, py::arg("path"),
           "Writes the block, whole or not at all. Training.save() writes the header too.")
      .def("to_bytes", &bytes_of, "The block.")
      .def("_words", [](const BlockModel& self) {
        return "<pinnquad.Model " + self.path() + ": " + self.answer() + ", " + std::to_string(self.features().size()) +
               " features, for " + self.airframe_name() + ">";
      });
  model_type = reinterpret_cast<PyTypeObject*>(model.ptr());
  predict_of_any = model.attr("predict").cast<py::object>().release().ptr();
  static PyMethodDef of_python = {
      "predict", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&called_predict)),
      METH_FASTCALL | METH_KEYWORDS,
      "predict($self, features, *, out=None)\n--\n\n"
      "Commands, 0 to 1, of features in physical units: (features,) gives (4,), (rows, features) gives (rows, 4).\n"
      "A DataFrame or a structured array is read by feature_names; of a DataFrame the answer is one. Answers are of\n"
      "the block's own scalar; they are written into the array `out`, which is returned, where it is given. A number\n"
      "that is not finite is a ValueError with its row. The envelope is not looked at: predict_guarded() does."};
  model.attr("predict") = py::reinterpret_steal<py::object>(PyDescr_NewMethod(model_type, &of_python));
  pickled(
      model, [](const py::object& self) { return bytes_of(self.cast<const BlockModel&>()); },
      [](const py::bytes& bytes) {
        return std::make_shared<BlockModel>("a pickled block", static_cast<std::string>(bytes));
      });
}

}  // namespace python
