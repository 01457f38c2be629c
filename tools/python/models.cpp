// SPDX-License-Identifier: MIT
// Models of blocks: loaded, asked one motion or many, judged, certified.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "model/evaluation.hpp"
#include "model/findings.hpp"
#include "pinnquad/exported/run_time_batch.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "python/interruptible.hpp"
#include "python/json.hpp"

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
template <class Number, class Model, class Scalar>
void answer(const Model& model, const Number* x, std::size_t rows, Scalar* u, std::uint8_t* statuses,
            SignalWatch& watch) {
  constexpr std::size_t most_at_once = 256, fewest_side_by_side = 4;
  const auto size = static_cast<std::size_t>(model.features().size());
  const std::size_t at_once = std::min(most_at_once, rows);
  std::vector<Scalar> own(at_once * size), work(std::max(batch_workspace(model), model.workspace()));
  for (std::size_t first = 0; first < rows; first += at_once) {
    const std::size_t count = std::min(at_once, rows - first);
    const Number* const given = x + first * size;
    for (std::size_t i = 0; i < count * size; ++i) own[i] = static_cast<Scalar>(given[i]);
    Scalar* const commands = u + first * rotor_count;
    if (count < fewest_side_by_side) {
      for (std::size_t row = 0; row < count; ++row) {
        model.commands(own.data() + row * size, commands + row * rotor_count, work.data());
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

py::object predict(const BlockModel& model, const py::object& features, bool guarded) {
  const GivenFeatures given(model, features);
  if (!guarded) given.is_double ? require_finite<double>(given) : require_finite<float>(given);
  return model.with([&](const auto& own) -> py::object {
    using Scalar = std::remove_const_t<std::remove_pointer_t<decltype(own.parameters())>>;
    const auto rows = static_cast<py::ssize_t>(given.rows), rotors = static_cast<py::ssize_t>(rotor_count);
    const bool one = given.array.ndim() == 1;
    py::array_t<Scalar> commands(one ? std::vector<py::ssize_t>{rotors} : std::vector<py::ssize_t>{rows, rotors});
    py::array_t<std::uint8_t> statuses(guarded ? rows : 0);
    Scalar* const u = commands.mutable_data();
    std::uint8_t* const said = guarded ? statuses.mutable_data() : nullptr;
    const void* const x = given.array.data();
    {
      const py::gil_scoped_release without_gil;
      SignalWatch watch;
      given.is_double ? answer(own, static_cast<const double*>(x), given.rows, u, said, watch)
                      : answer(own, static_cast<const float*>(x), given.rows, u, said, watch);
    }
    if (!guarded) return named_as(features, std::move(commands));
    return py::make_tuple(named_as(features, commands),
                          one ? py::module_::import("pinnquad").attr("Status")(said[0]) : py::object(statuses));
  });
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

py::object evaluate(const BlockModel& model, const py::object& flights, const std::string& rows) {
  if (rows != "all" && rows != "test") refuse_name("rows", rows, std::array<const char*, 2>{"all", "test"});
  const std::shared_ptr<const Dataset> dataset = dataset_of(flights);
  nlohmann::json report;
  {
    const py::gil_scoped_release without_gil;
    SignalWatch watch;
    const programs::EvaluatedModel evaluation =
        programs::evaluated(model, programs::rows_to_judge(*dataset, rows), [&watch](double) { watch.look(); });
    report = programs::evaluation_json(model, *dataset, rows, evaluation);
  }
  return to_python(report);
}

py::object certify(const BlockModel& model, double seconds, std::uint64_t seed) {
  checked("seconds", seconds, 0.01);
  nlohmann::json report;
  run_interruptible([&] { report = programs::findings_json(model, programs::findings_of(model, seconds, seed)); });
  return to_python(report);
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
          "predict", [](const BlockModel& self, const py::object& x) { return predict(self, x, false); },
          py::arg("features"),
          "Commands, 0 to 1, of features in physical units: (features,) gives (4,), (rows, features) gives (rows, 4).\n"
          "A DataFrame or a structured array is read by feature_names; of a DataFrame the answer is one. Answers are "
          "of\n"
          "the block's own scalar. A number that is not finite is a ValueError with its row. The envelope is not "
          "looked\n"
          "at: predict_guarded() does.")
      .def(
          "predict_guarded", [](const BlockModel& self, const py::object& x) { return predict(self, x, true); },
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
      .def("__repr__", [](const BlockModel& self) {
        return "<pinnquad.Model " + self.path() + ": " + self.answer() + ", " + std::to_string(self.features().size()) +
               " features, for " + self.airframe_name() + ">";
      });
  pickled(
      model, [](const py::object& self) { return bytes_of(self.cast<const BlockModel&>()); },
      [](const py::bytes& bytes) {
        return std::make_shared<BlockModel>("a pickled block", static_cast<std::string>(bytes));
      });
  module.def("_evaluate", &evaluate, py::arg("model"), py::arg("flights"), py::arg("rows"), "Of pinnquad.evaluate().");
  module.def("_certify", &certify, py::arg("model"), py::arg("seconds"), py::arg("seed").noconvert(),
             "Of pinnquad.certify().");
}

}  // namespace python
