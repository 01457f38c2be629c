// SPDX-License-Identifier: MIT
// The vehicle that flew, as `pinnquad identify` finds it.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "identify/told_vehicle.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "python/interruptible.hpp"
#include "python/json.hpp"

namespace python {

namespace {

using pinnquad::logs::ImportedDataset;

struct Identification {
  programs::ToldVehicle vehicle;  ///< with an airframe
  std::string name;
  std::vector<std::string> warnings;

  NamedAirframe airframe() const { return {name, *vehicle.airframe}; }
};

/// Each of them once: a log was looked at when it was read, too.
void leave_one_of_each(std::vector<std::string>& lines) {
  std::vector<std::string> kept;
  for (std::string& line : lines) {
    if (std::find(kept.begin(), kept.end(), line) == kept.end()) kept.push_back(std::move(line));
  }
  lines = std::move(kept);
}

Identification identify(const py::object& flights, const programs::SaidOfVehicle& said, const std::string& name) {
  ImportedDataset dataset;
  if (py::isinstance<ImportedDataset>(flights)) dataset = flights.cast<const ImportedDataset&>();
  if (dataset.flights.size() == 0) dataset.flights = *dataset_of(flights);
  if (dataset.flights.size() == 0) throw py::value_error("expected flights, found none");
  if (dataset.sources.size() != dataset.flights.size()) {  // in memory: what is refused has a name alone
    dataset.sources.clear();
    for (const pinnquad::Flight& flight : dataset.flights.flights()) dataset.sources.push_back(flight.name);
  }
  Identification identification{{}, name, {}};
  run_interruptible([&] { identification.vehicle = programs::told_vehicle(dataset, said, false); });
  if (!identification.vehicle.airframe) refuse(identification.vehicle.why_not);
  leave_one_of_each(dataset.warnings);
  identification.warnings = std::move(dataset.warnings);
  return identification;
}

/// None: the airframe's; 'fit', or a number from 0 to 1.
void take_thrust_curve(const py::object& given, programs::SaidOfVehicle& said) {
  if (given.is_none()) return;
  if (py::isinstance<py::str>(given)) {
    const auto word = given.cast<std::string>();
    if (word != "fit") refuse_name("thrust_curve", word, std::array<const char*, 1>{"fit"});
    said.fit_thrust_curve = true;
    return;
  }
  const auto curve = given.cast<double>();
  if (!(curve >= 0 && curve <= 1)) throw py::value_error("thrust_curve must be 'fit', or a number from 0 to 1");
  said.thrust_curve = curve;
}

}  // namespace

void bind_identification(py::module_& module) {
  py::class_<Identification> identification(module, "Identification", "A vehicle as its flights tell it.");
  identification
      .def_property_readonly(
          "_numbers",
          [](const Identification& self) { return to_python(programs::numbers_json(self.vehicle.numbers)); },
          "Of numbers.")
      .def_property_readonly("airframe", &Identification::airframe,
                             "An Airframe for simulators, train() and every command; a new one each time.")
      .def_property_readonly(
          "assumed", [](const Identification& self) { return self.vehicle.assumed; },
          "What the airframe has and the flights do not tell: the mass, the arms ...")
      .def_readonly("warnings", &Identification::warnings, "What looks wrong in the flights.")
      .def_property_readonly(
          "duration_s", [](const Identification& self) { return self.vehicle.found.duration_s; }, "Flight used, s.")
      .def(
          "save",
          [](const Identification& self, const std::filesystem::path& path) {
            pinnquad::AtomicFile file(path.string());
            file.stream() << programs::vehicle_toml(self.vehicle, self.name);
            file.commit();
          },
          py::arg("path"), "Writes the file of `identify --out`: the airframe, with intervals as comments.")
      .def("__repr__", [](const Identification& self) {
        const auto& numbers = self.vehicle.numbers;
        const auto told = std::count_if(numbers.begin(), numbers.end(), programs::is_told);
        return "<pinnquad.Identification " + pinnquad::printable(self.name) + ": " + std::to_string(told) + " of " +
               std::to_string(numbers.size()) + " numbers determined>";
      });
  refuse_new(identification);
  module.def(
      "identify",
      [](const py::object& flights, const py::object& airframe, const std::optional<double>& mass_kg,
         const std::optional<double>& arm_m, const py::object& thrust_curve, const std::string& name) {
        programs::SaidOfVehicle said;
        if (!airframe.is_none()) said.airframe = airframe_of(airframe);
        if (mass_kg) said.mass_kg = checked("mass_kg", *mass_kg, 1e-3);
        if (arm_m) said.arm_m = checked("arm_m", *arm_m, 1e-3);
        take_thrust_curve(thrust_curve, said);
        said.mass_option = "mass_kg";
        said.arm_option = "arm_m";
        return identify(flights, said, name);
      },
      py::arg("flights"), py::arg("airframe") = py::none(), py::kw_only(), py::arg("mass_kg") = py::none(),
      py::arg("arm_m") = py::none(), py::arg("thrust_curve") = py::none(), py::arg("name") = "identified",
      "The vehicle that flew: the numbers of `pinnquad identify`, with their 95 % intervals.\n\n"
      "flights       a Dataset, a Flight or a list of them\n"
      "airframe      gives mass, arms, motor order and propeller: an Airframe, a name, or a TOML file; None: 1 kg,\n"
      "              0.2 m, PX4's order\n"
      "mass_kg       kg; no flight tells it\n"
      "arm_m         of each rotor along x and y, m; no flight tells it\n"
      "thrust_curve  from thrust proportional to the command, 0, to its square, 1; 'fit' finds it; None: the "
      "airframe's\n"
      "name          of the airframe\n\n"
      "pinnquad.Error for flights that do not tell thrust, roll or pitch, with the flight that would, and for flights\n"
      "at rest, with frozen rates or motors at their limit; ValueError where they contradict each other.\n"
      "Other threads run meanwhile; Ctrl-C ends it, and nothing is kept.");
}

}  // namespace python
