// SPDX-License-Identifier: MIT
// Flights and datasets: the rows of the library's tables as NumPy arrays, where they lie.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/logs/dataset_folder.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "python/bindings.hpp"

namespace python {

namespace {

using pinnquad::Dataset;
using pinnquad::Flight;
using pinnquad::Sample;
using pinnquad::logs::ImportedDataset;

static_assert(sizeof(Sample) == pinnquad::sample_value_count * sizeof(double),
              "pinnquad: a flight is shown to Python as rows of 21 numbers");

/// Quantities of a Sample.
constexpr std::array<RowPart, 8> quantities = {
    {{"time_s", 0, 1, "Time, s; it increases from row to row."},
     {"linear_acceleration_m_s2", 1, 3, "Derivative of the body-frame velocity, m/s^2, FRD: R^T a_world - omega x v."},
     {"angular_acceleration_rad_s2", 4, 3, "Derivative of the body rates, rad/s^2, FRD."},
     {"velocity_m_s", 7, 3, "Velocity over ground in the body frame, m/s, FRD."},
     {"body_rates_rad_s", 10, 3, "p, q, r, rad/s, FRD."},
     {"euler_rad", 13, 3, "Roll, pitch, yaw (ZYX, body to NED), rad."},
     {"altitude_m", 16, 1, "Of the vehicle's centre above the ground below it, m."},
     {"commands", 17, 4, "Motor commands, 0 to 1: front right, rear left, front left, rear right."}}};

py::array array_of_quantity(const py::object& self, const RowPart& quantity) {
  const auto& flight = self.cast<const Flight&>();
  const double* const first = flight.empty() ? nullptr : reinterpret_cast<const double*>(&flight.front());
  return part_of_rows(first, flight.size(), sizeof(Sample), quantity, self);
}

py::array rows_of(const py::object& self) {
  return array_of_quantity(self, {"rows", 0, static_cast<py::ssize_t>(pinnquad::sample_value_count), ""});
}

py::array column_of(const py::object& self, const std::string& name) {
  for (const RowPart& quantity : quantities) {
    if (name == quantity.name) return array_of_quantity(self, quantity);
  }
  const auto& flight = self.cast<const Flight&>();
  for (std::size_t i = 0; i < pinnquad::sample_value_count; ++i) {
    if (name == pinnquad::sample_field_names[i])
      return array_of_quantity(self, {"", static_cast<py::ssize_t>(i), 1, ""});
  }
  if (const pinnquad::ExtraColumn* column = flight.column(name)) {
    return view_of(column->values.data(), {static_cast<py::ssize_t>(flight.size())},
                   {static_cast<py::ssize_t>(sizeof(double))}, self);
  }
  std::vector<std::string> known;
  for (const RowPart& quantity : quantities) known.emplace_back(quantity.name);
  for (const pinnquad::ExtraColumn& column : flight.columns()) known.push_back(column.name);
  refuse_name("column", name, known);
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Columns = std::vector<std::tuple<std::string, std::string, std::vector<double>>>;

std::vector<std::string> names_of_columns() {
  return {std::begin(pinnquad::sample_field_names), std::end(pinnquad::sample_field_names)};
}

/// As files of flights are read.
void require_finite(std::size_t row, std::string_view column, double value) {
  if (pinnquad::is_finite(value)) return;
  throw py::value_error("row " + std::to_string(row) + ", column " + std::string(column) +
                        ": expected a finite number, found " + std::to_string(value));
}

std::shared_ptr<Flight> made(const py::object& given, const std::string& name, const std::string& trajectory,
                             double weight, const Columns& columns) {
  const Numbers rows = doubles("rows", given, names_of_columns());
  if (rows.ndim() != 2 || static_cast<std::size_t>(rows.shape(1)) != pinnquad::sample_value_count) {
    throw py::value_error("rows must be an array of 21 columns, those of column_names");
  }
  auto flight = std::make_shared<Flight>();
  flight->name = name;
  flight->trajectory = trajectory;
  flight->weight = weight;
  flight->reserve(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t row = 0; row < rows.shape(0); ++row) {
    Sample::Values values;
    std::copy_n(rows.data(row, 0), values.size(), values.begin());
    for (std::size_t i = 0; i < values.size(); ++i) {
      require_finite(static_cast<std::size_t>(row), pinnquad::sample_field_names[i], values[i]);
    }
    if (!flight->empty() && !(values[0] > flight->back().time_s)) {
      throw py::value_error("row " + std::to_string(row) + ": time does not increase");
    }
    flight->push_back(pinnquad::to_sample(values));
  }
  for (const auto& [column, unit, values] : columns) {
    flight->add_column({{column, unit}, values});
    for (std::size_t row = 0; row < values.size(); ++row) require_finite(row, pinnquad::printable(column), values[row]);
  }
  return flight;
}

Columns columns_of(const Flight& flight) {
  Columns columns;
  for (const pinnquad::ExtraColumn& column : flight.columns()) {
    columns.emplace_back(column.name, column.unit, column.values);
  }
  return columns;
}

std::shared_ptr<Flight> read_flight(const std::filesystem::path& path) {
  auto flight = std::make_shared<Flight>(pinnquad::read_flight_csv(path.string(), pinnquad::minimum_flight_rows,
                                                                   pinnquad::extra_columns_in(path.string())));
  flight->name = path.filename().string();
  return flight;
}

std::shared_ptr<ImportedDataset> read(const std::vector<std::filesystem::path>& paths,
                                      const std::optional<std::filesystem::path>& mapping,
                                      const std::optional<std::filesystem::path>& airframe,
                                      const std::optional<double>& lag_s, bool keep_saturated) {
  std::vector<std::string> texts;
  for (const std::filesystem::path& path : paths) texts.push_back(path.string());
  pinnquad::logs::LogSettings settings;
  settings.mapping = mapping.value_or("").string();
  settings.airframe = airframe.value_or("").string();
  settings.lag_s = lag_s;
  settings.keep_saturated = keep_saturated;
  if (lag_s && pinnquad::logs::kind_of_sources(texts, settings.mapping) != pinnquad::logs::SourceKind::logs) {
    throw py::value_error("lag_s: only logs are imported with one");
  }
  SignalWatch watch;
  settings.on_progress = [&watch](const std::string&, double) { watch.look(); };
  const py::gil_scoped_release without_gil;
  return std::make_shared<ImportedDataset>(pinnquad::logs::read_source(texts, settings));
}

/// Of flights that stay where they are: a flight in Python keeps its dataset.
py::object flight_at(const py::object& self, py::ssize_t index) {
  const Dataset& flights = self.cast<const ImportedDataset&>().flights;
  const auto count = static_cast<py::ssize_t>(flights.size());
  if (index < 0) index += count;
  if (index < 0 || index >= count)
    throw py::index_error("flight " + std::to_string(index) + " of " + std::to_string(count));
  auto shared = self.cast<std::shared_ptr<ImportedDataset>>();
  const Flight& flight = flights[static_cast<std::size_t>(index)];
  return py::cast(std::shared_ptr<Flight>(shared, const_cast<Flight*>(&flight)));
}

/// Flights in memory as a dataset whose period is theirs.
std::shared_ptr<ImportedDataset> with_period(Dataset flights) {
  auto own = std::make_shared<ImportedDataset>();
  own->flights = std::move(flights);
  own->sample_period_s = pinnquad::sample_period_s(pinnquad::all_rows(own->flights.flights()));
  return own;
}

/// Rows of other flights as flights of their own.
std::shared_ptr<ImportedDataset> dataset_of_rows(const pinnquad::RowSet& rows) {
  Dataset own;
  for (const pinnquad::FlightRows& piece : rows.pieces()) {
    Flight flight = *piece.flight;
    flight.keep_rows([&piece](std::size_t row) { return row >= piece.rows.begin && row < piece.rows.end; });
    own.add(std::move(flight));
  }
  return with_period(std::move(own));
}

py::tuple split(const py::object& flights) {
  const std::shared_ptr<const Dataset> dataset = dataset_of(flights);
  const auto parts = pinnquad::split_for_training(*dataset);
  return py::make_tuple(dataset_of_rows(parts.train), dataset_of_rows(parts.validation), dataset_of_rows(parts.test));
}

}  // namespace

std::shared_ptr<const Dataset> dataset_of(py::handle given) {
  if (py::isinstance<ImportedDataset>(given)) {
    const auto imported = given.cast<std::shared_ptr<ImportedDataset>>();
    return {imported, &imported->flights};
  }
  auto dataset = std::make_shared<Dataset>();
  const auto add = [&dataset](const Flight& flight) {
    Flight named = flight;
    if (named.name.empty()) named.name = "flight " + std::to_string(dataset->size() + 1);
    dataset->add(std::move(named));
  };
  if (py::isinstance<Flight>(given)) {
    add(given.cast<const Flight&>());
  } else if (py::isinstance<py::sequence>(given) && !py::isinstance<py::str>(given)) {
    for (const py::handle flight : given) {
      if (!py::isinstance<Flight>(flight)) throw py::type_error("expected a Dataset, a Flight or a list of flights");
      add(flight.cast<const Flight&>());
    }
  } else {
    throw py::type_error("expected a Dataset, a Flight or a list of flights");
  }
  return dataset;
}

void bind_flights(py::module_& module) {
  py::class_<Flight, std::shared_ptr<Flight>> flight(
      module, "Flight",
      "Rows of one flight, in time order. Its arrays are the library's memory, read-only: nothing is copied, and they "
      "keep it alive.");
  flight
      .def(py::init(&made), py::arg("rows"), py::arg("name") = "", py::arg("trajectory") = "", py::arg("weight") = 1.0,
           py::arg("columns") = Columns{},
           "N x 21 numbers, SI units: an array in the order of column_names, or a DataFrame or a structured array by\n"
           "these names; and extra columns (name, unit, values).")
      .def_static("read", &read_flight, py::arg("path"),
                  "A CSV file (docs/train.md), with its extra columns. pinnquad.Error says file, line and column.")
      .def_readonly("name", &Flight::name)
      .def_readonly("trajectory", &Flight::trajectory, "Flights of one trajectory are held out together.")
      .def_readonly("weight", &Flight::weight, "How often its rows are seen in training, relative to other flights.")
      .def_property_readonly("rows", &rows_of, "All numbers, N x 21, in the order of column_names.")
      .def_property_readonly(
          "columns",
          [](const Flight& self) {
            std::vector<std::pair<std::string, std::string>> names;
            for (const pinnquad::ExtraColumn& column : self.columns()) names.emplace_back(column.name, column.unit);
            return names;
          },
          "Names and units of the extra columns.")
      .def("__getitem__", &column_of, py::arg("name"), "A quantity, one of column_names, or an extra column.")
      .def(
          "save",
          [](const Flight& self, const std::filesystem::path& path) {
            pinnquad::write_flight_csv(path.string(), self);
          },
          py::arg("path"), "Writes the CSV that `pinnquad fly` writes. OSError if that is not possible.")
      .def("__len__", &Flight::size)
      .def("__repr__", [](const Flight& self) {
        return "<pinnquad.Flight " + pinnquad::printable(self.name) + ": " + std::to_string(self.size()) + " rows>";
      });
  pickled(
      flight,
      [](const py::object& self) {
        const auto& own = self.cast<const Flight&>();
        return py::make_tuple(rows_of(self), own.name, own.trajectory, own.weight, columns_of(own));
      },
      [](const py::tuple& state) {
        return made(state[0], state[1].cast<std::string>(), state[2].cast<std::string>(), state[3].cast<double>(),
                    state[4].cast<Columns>());
      });
  py::tuple names(pinnquad::sample_value_count);
  for (std::size_t i = 0; i < pinnquad::sample_value_count; ++i) {
    names[i] = py::str(std::string(pinnquad::sample_field_names[i]));
  }
  flight.attr("column_names") = names;
  for (const RowPart& quantity : quantities) {
    flight.def_property_readonly(
        quantity.name, [&quantity](const py::object& self) { return array_of_quantity(self, quantity); }, quantity.doc);
  }

  py::class_<ImportedDataset, std::shared_ptr<ImportedDataset>> dataset(module, "Dataset",
                                                                        "Flights, each on a clock of its own.");
  dataset
      .def(py::init([](const py::object& flights) {
             if (!py::isinstance<ImportedDataset>(flights)) return with_period(*dataset_of(flights));
             return std::make_shared<ImportedDataset>(flights.cast<const ImportedDataset&>());
           }),
           py::arg("flights"), "Of flights, which are copied.")
      .def_static(
          "read", &read, py::arg("paths"), py::kw_only(), py::arg("mapping") = py::none(),
          py::arg("airframe") = py::none(), py::arg("lag_s") = py::none(), py::arg("keep_saturated") = false,
          "Flights as CSV, a dataset that `pinnquad import` wrote, or logs (ULog, CSV, Crazyflie), whose "
          "columns get their meaning from a mapping:\na name (px4, betaflight, crazyflie ...) or a TOML file; flights "
          "and "
          "datasets need None. Of logs: "
          "`lag_s`, from command to motion, is removed (None: estimated),\nand rows with a command at its limit "
          "are left out unless `keep_saturated`.")
      .def(
          "save",
          [](const ImportedDataset& self, const std::filesystem::path& path) {
            pinnquad::logs::write_dataset_folder(path.string(), self);
          },
          py::arg("path"), "Writes the folder that `pinnquad import` writes, whole or not at all.")
      .def_readonly("sample_period_s", &ImportedDataset::sample_period_s, "Of the rows, s.")
      .def_readonly("lag_removed_s", &ImportedDataset::lag_removed_s, "By how much the commands were moved, s.")
      .def_readonly("absent", &ImportedDataset::absent, "Quantities that the logs lack: 'velocity', 'altitude'.")
      .def_readonly("warnings", &ImportedDataset::warnings, "What looks wrong in the logs.")
      .def_readonly("notes", &ImportedDataset::notes, "How what the logs lack was computed.")
      .def_property_readonly(
          "rows", [](const ImportedDataset& self) { return self.flights.rows(); }, "Of all flights.")
      .def("__getitem__", &flight_at, py::arg("index").noconvert())
      .def("__len__", [](const ImportedDataset& self) { return self.flights.size(); })
      .def("__repr__", [](const ImportedDataset& self) {
        return "<pinnquad.Dataset: " + std::to_string(self.flights.size()) + " flights, " +
               std::to_string(self.flights.rows()) + " rows>";
      });
  refuse_new(dataset);
  module.def(
      "split", &split, py::arg("flights"),
      "(train, validation, test), three Datasets: the rows that train() parts these flights into. One flight is cut\n"
      "in time, 60, 20 and 20 %; of three or more the last are held out whole.");
}

}  // namespace python
