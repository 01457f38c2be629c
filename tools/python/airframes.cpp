// SPDX-License-Identifier: MIT
// Airframes: by name, from TOML files, edited, pickled.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "airframe/toml_writer.hpp"
#include "command_line/in_words.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "python/bindings.hpp"

namespace python {

namespace {

using pinnquad::Airframe;
using pinnquad::Spin;
using Rotor = pinnquad::RotorMount<double>;

/// A triple of a value that Python edits in place; `owner` keeps it alive.
py::array edited(Triple& numbers, py::handle owner) {
  return py::array(py::dtype::of<double>(), {3}, {static_cast<py::ssize_t>(sizeof(double))}, numbers.data(), owner);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  programs::each_airframe([&all](auto tag) { all.emplace_back(decltype(tag)::type::name); });
  return all;
}

pinnquad::Status status_of(const Airframe<double>& airframe) {
  const pinnquad::Status status = check_airframe(airframe);
  return status == pinnquad::Status::ok ? pinnquad::Rotors<double>(airframe).status() : status;
}

void check(const NamedAirframe& airframe) {
  const pinnquad::Status status = status_of(airframe.value);
  if (status != pinnquad::Status::ok) {
    refuse("airframe " + pinnquad::printable(airframe.name) + ": " + to_string(status) +
           ", its values are no quadrotor's that can hover");
  }
}

/// Calls `visit(name, number)` for every number that has a spread: of a rotor by the rotor's name for it.
template <class Visit>
void each_spread(Airframe<double>& a, const Visit& visit) {
  const auto three = [&visit](const char* name, Triple& numbers) {
    for (double& number : numbers) visit(name, number);
  };
  visit("mass_kg", a.mass_kg);
  three("inertia_kg_m2", a.inertia_kg_m2);
  three("inertia_products_kg_m2", a.inertia_products_kg_m2);
  visit("thrust_coefficient", a.thrust_coefficient);
  visit("power_coefficient", a.power_coefficient);
  visit("propeller_diameter_m", a.propeller_diameter_m);
  visit("max_rotor_speed_rev_s", a.max_rotor_speed_rev_s);
  visit("rotor_time_constant_s", a.rotor_time_constant_s);
  three("drag_area_m2", a.drag_area_m2);
  for (Rotor& rotor : a.rotors) {
    visit("x_m", rotor.x_m);
    visit("y_m", rotor.y_m);
    visit("z_m", rotor.z_m);
    visit("thrust_scale", rotor.thrust_scale);
    visit("thrust_curve", rotor.thrust_curve);
    visit("rise_time_constant_s", rotor.rise_time_constant_s);
    visit("fall_time_constant_s", rotor.fall_time_constant_s);
  }
}

using Spreads = std::map<std::string, double>;

void check(const Spreads& spreads) {
  std::vector<std::string> known;
  Airframe<double> any{};
  each_spread(any, [&known](const char* name, double) {
    if (std::find(known.begin(), known.end(), name) == known.end()) known.emplace_back(name);
  });
  for (const auto& [name, spread] : spreads) {
    if (std::find(known.begin(), known.end(), name) == known.end()) refuse_name("spread", name, known);
    if (!(spread >= 0 && spread < 1)) {
      throw py::value_error("the spread of " + name + " must be a number from 0 to less than 1");
    }
  }
}

/// Every number draws, so that a spread more or less leaves the others' draws as they are.
Airframe<double> drawn(const Airframe<double>& middle, const Spreads& spreads, std::mt19937_64& engine) {
  Airframe<double> airframe = middle;
  each_spread(airframe, [&](const char* name, double& number) {
    const double off = pinnquad::uniform(engine, -1, 1);
    const auto spread = spreads.find(name);
    const bool of_the_airframe = number < 0 && std::string(name).find("_time_constant_s") != std::string::npos;
    if (spread != spreads.end() && !of_the_airframe) number *= 1 + spread->second * off;
  });
  return airframe;
}

py::list randomised(const NamedAirframe& middle, std::size_t count, const Spreads& spreads, std::uint64_t seed) {
  check(spreads);
  constexpr int tries = 1000;
  std::mt19937_64 engine(seed);
  py::list airframes;
  for (std::size_t i = 0; i < count; ++i) {
    NamedAirframe one = middle;
    int left = tries;
    do {
      if (left-- == 0) {
        refuse("airframe " + pinnquad::printable(middle.name) + ": of " + std::to_string(tries) +
               " drawn with these spreads none can hover");
      }
      one.value = drawn(middle.value, spreads, engine);
    } while (status_of(one.value) != pinnquad::Status::ok);
    airframes.append(std::move(one));
  }
  return airframes;
}

py::tuple state_of(NamedAirframe airframe) {
  py::list numbers;
  each_number(airframe.value, [&numbers](auto& number) { numbers.append(static_cast<double>(number)); });
  return py::make_tuple(airframe.name, py::tuple(numbers));
}

NamedAirframe of_state(const py::tuple& state) {
  NamedAirframe airframe{state[0].cast<std::string>(), {}};
  const auto numbers = state[1].cast<std::vector<double>>();
  if (numbers.size() != static_cast<std::size_t>(pinnquad::airframe_number_count)) {
    throw py::value_error("a pickled airframe has " + std::to_string(pinnquad::airframe_number_count) +
                          " numbers, found " + std::to_string(numbers.size()));
  }
  std::size_t next = 0;
  each_number(airframe.value, [&](auto& number) {
    const double value = numbers[next++];
    if constexpr (std::is_same_v<std::decay_t<decltype(number)>, Spin>) {
      number = value < 0 ? Spin::clockwise : Spin::counter_clockwise;
    } else {
      number = value;
    }
  });
  return airframe;
}

template <class Class, class Value>
void number(Class& bound, const char* name, double Value::*field, const char* doc) {
  using Bound = typename Class::type;
  const auto value_of = [](auto& self) -> auto& {
    if constexpr (std::is_same_v<std::decay_t<decltype(self)>, Value>) {
      return self;
    } else {
      return self.value;
    }
  };
  bound.def_property(
      name, [=](const Bound& self) { return value_of(self).*field; },
      [=](Bound& self, double value) { value_of(self).*field = value; }, doc);
}

}  // namespace

NamedAirframe airframe_of(py::handle given) {
  if (py::isinstance<NamedAirframe>(given)) return given.cast<const NamedAirframe&>();
  if (py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__")) {
    return pinnquad::logs::chosen_airframe(py::module_::import("os").attr("fspath")(given).cast<std::string>());
  }
  throw py::type_error("expected an Airframe, or the name or the file of one");
}

void bind_airframes(py::module_& module) {
  py::enum_<Spin>(module, "Spin", "Sense of rotation seen from the side to which the rotor pulls: from above.")
      .value("counter_clockwise", Spin::counter_clockwise)
      .value("clockwise", Spin::clockwise);

  py::class_<Rotor> rotor(module, "Rotor", "Place, axis, thrust and lag of one rotor; body axes, FRD.");
  number(rotor, "x_m", &Rotor::x_m, "Forward of the centre of gravity, m.");
  number(rotor, "y_m", &Rotor::y_m, "Right of the centre of gravity, m.");
  number(rotor, "z_m", &Rotor::z_m, "Below the centre of gravity, m.");
  rotor.def_readwrite("spin", &Rotor::spin, "A counter-clockwise upright rotor yaws the body clockwise.")
      .def_property(
          "axis", [](py::object self) { return edited(self.cast<Rotor&>().axis, self); },
          [](Rotor& self, const Triple& axis) { self.axis = axis; }, "Unit vector along the thrust; (0, 0, -1) is up.");
  number(rotor, "thrust_scale", &Rotor::thrust_scale, "Thrust and torque over those of the airframe's coefficients.");
  number(rotor, "thrust_curve", &Rotor::thrust_curve,
         "0: thrust is proportional to the command; 1: to its square; between: a mixture.");
  number(rotor, "rise_time_constant_s", &Rotor::rise_time_constant_s, "Lag of growing thrust, s; -1: the airframe's.");
  number(rotor, "fall_time_constant_s", &Rotor::fall_time_constant_s, "Lag of falling thrust, s; -1: the airframe's.");

  py::class_<NamedAirframe> airframe(
      module, "Airframe", "The values of a quadrotor. `copy()` makes one to edit; `check()` says whether it can fly.");
  airframe
      .def(py::init([](const py::object& name_or_file) { return airframe_of(name_or_file); }), py::arg("name_or_file"),
           "One of airframe_names(), or a TOML file (examples/airframes; `pinnquad identify` and `airframe` write "
           "some).")
      .def_readwrite("name", &NamedAirframe::name);
  using Values = Airframe<double>;
  number(airframe, "mass_kg", &Values::mass_kg, "Mass, kg.");
  airframe
      .def_property(
          "inertia_kg_m2",
          [](py::object self) { return edited(self.cast<NamedAirframe&>().value.inertia_kg_m2, self); },
          [](NamedAirframe& self, const Triple& values) { self.value.inertia_kg_m2 = values; },
          "Jx, Jy, Jz, kg m^2, FRD; to be edited in place too.")
      .def_property(
          "inertia_products_kg_m2",
          [](py::object self) { return edited(self.cast<NamedAirframe&>().value.inertia_products_kg_m2, self); },
          [](NamedAirframe& self, const Triple& values) { self.value.inertia_products_kg_m2 = values; },
          "Jxy, Jxz, Jyz, kg m^2: the other entries of the inertia matrix.")
      .def_property_readonly(
          "rotors",
          [](py::object self) {
            py::list rotors;
            for (Rotor& one : self.cast<NamedAirframe&>().value.rotors) {
              rotors.append(py::cast(&one, py::return_value_policy::reference_internal, self));
            }
            return py::tuple(rotors);
          },
          "Four Rotors in the order of the commands: front right, rear left, front left, rear right.");
  number(airframe, "thrust_coefficient", &Values::thrust_coefficient, "C_T = thrust / (rho n^2 D^4), n in rev/s.");
  number(airframe, "power_coefficient", &Values::power_coefficient, "C_P = 2 pi torque / (rho n^2 D^5).");
  number(airframe, "propeller_diameter_m", &Values::propeller_diameter_m, "D, m.");
  number(airframe, "max_rotor_speed_rev_s", &Values::max_rotor_speed_rev_s, "n at command 1, rev/s.");
  number(airframe, "rotor_time_constant_s", &Values::rotor_time_constant_s, "First-order lag of the thrust, s.");
  airframe.def_property(
      "drag_area_m2", [](py::object self) { return edited(self.cast<NamedAirframe&>().value.drag_area_m2, self); },
      [](NamedAirframe& self, const Triple& values) { self.value.drag_area_m2 = values; },
      "k of F = -k rho |v| v along each body axis, m^2.");
  number(airframe, "drag_deadband_m_s", &Values::drag_deadband_m_s, "No drag along an axis at or below it, m/s.");
  airframe
      .def_property_readonly(
          "thrust_to_weight", [](const NamedAirframe& self) { return self.value.thrust_to_weight(); },
          "Thrust of all rotors at command 1 over the weight, at sea level.")
      .def("check", py::overload_cast<const NamedAirframe&>(&check),
           "Raises pinnquad.Error for values that no quadrotor has that can hover.")
      .def("randomised", &randomised, py::arg("count").noconvert(), py::arg("spreads"), py::arg("seed").noconvert() = 1,
           "A list of `count` airframes around this one: each number that `spreads` names, {\"mass_kg\": 0.2,\n"
           "\"thrust_scale\": 0.05}, times a factor drawn for it, uniform between 1 - spread and 1 + spread; of the\n"
           "airframe's attributes or its rotors'. What can't hover is drawn again. The same seed gives the same bits.")
      .def(
          "copy", [](const NamedAirframe& self) { return self; }, "Another one, to edit.")
      .def("__copy__", [](const NamedAirframe& self) { return self; })
      .def("__deepcopy__", [](const NamedAirframe& self, const py::dict&) { return self; })
      .def("to_toml", &programs::airframe_toml, "The text of a file that Airframe(path) reads, bit for bit.")
      .def(
          "save",
          [](const NamedAirframe& self, const std::filesystem::path& path) {
            pinnquad::AtomicFile file(path.string());
            file.stream() << programs::airframe_toml(self);
            file.commit();
          },
          py::arg("path"), "Writes the TOML file, whole or not at all.")
      .def("__eq__",
           [](const NamedAirframe& self, const py::object& other) {
             return py::isinstance<NamedAirframe>(other) &&
                    state_of(self).equal(state_of(other.cast<const NamedAirframe&>()));
           })
      .def("__repr__", [](const NamedAirframe& self) {
        return "<pinnquad.Airframe " + pinnquad::printable(self.name) +
               programs::in_words(": %.4g kg, thrust-to-weight %.3f>", self.value.mass_kg,
                                  self.value.thrust_to_weight());
      });
  pickled(
      airframe, [](const py::object& self) { return state_of(self.cast<const NamedAirframe&>()); }, of_state);
  refuse_new(rotor);
  module.def("airframe_names", &names, "Names of the airframes of the library.");
}

}  // namespace python
