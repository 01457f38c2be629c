// SPDX-License-Identifier: MIT
// Many vehicles stepped by one call, of one airframe or each of its own. Their states are one array, where they lie.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "python/effects.hpp"
#include "python/vehicle_steps.hpp"

namespace python {

namespace {

using namespace pinnquad;
using OneState = VehicleState<double>;

static_assert(sizeof(OneState) == state_numbers * sizeof(double),
              "pinnquad: vehicles are shown to Python as rows of 19 numbers");

/// Parts of a state.
constexpr std::array<RowPart, 8> parts = {
    {{"state", 0, state_numbers, "All numbers, vehicles x 19: those below in this order. To be written to, too."},
     {"position_m", 0, 3, "NED, m; the ground is at z = 0.877 m."},
     {"velocity_m_s", 3, 3, "NED, m/s."},
     {"attitude", 6, 4, "Unit quaternions w, x, y, z, body to world."},
     {"body_rates_rad_s", 10, 3, "p, q, r, FRD, rad/s."},
     {"rotor_commands", 13, 4, "Commands at which the present thrusts would be settled, behind the lag."},
     {"time_s", 17, 1, "Of each vehicle, s: for gusts and faults."},
     {"charge_used_C", 18, 1, "Of each vehicle's battery, since the start."}}};

/// An airframe for all, or one for each of `count`.
std::vector<NamedAirframe> airframes_of(const py::object& given, std::size_t count) {
  if (!PySequence_Check(given.ptr()) || py::isinstance<py::str>(given) || py::isinstance<py::bytes>(given)) {
    return {airframe_of(given)};
  }
  const auto sequence = given.cast<py::sequence>();
  if (sequence.size() != count) {
    throw py::value_error("airframe must be one, or " + std::to_string(count) + ", one per vehicle; found " +
                          std::to_string(sequence.size()));
  }
  std::vector<NamedAirframe> airframes;
  airframes.reserve(count);
  for (const py::handle one : sequence) airframes.push_back(airframe_of(one));
  return airframes;
}

class Vehicles {
 public:
  Vehicles(std::size_t count, const std::vector<NamedAirframe>& airframes, const py::object& effects,
           double physics_step_s)
      : airframes_(airframes),
        effects_(effects),
        physics_step_s_(checked("physics_step_s", physics_step_s, 1e-6)),
        flown_(effects_of(effects)),
        stepped_(flown_),
        vehicle_(vehicle_of(airframes.at(0), flown_)),
        states_(count) {
    for (std::size_t i = 1; i < airframes_.size(); ++i) {
      require_flying(with(airframes_[i].value), airframes_[i], i);
    }
    calls_python_ = calls_python(flown_);
    if (std::get<Switched<OwnWind, Usually::off>>(flown_).on && effects.attr("ground_contact").cast<bool>()) {
      throw py::value_error("effects: vehicles take no wind_m_s() with ground_contact; a Simulator does");
    }
    switch_effect(stepped_, OwnWind{}, false);
    switch_effect(stepped_, OwnWrench{}, false);
    put_in_lanes();
    reset(py::none(), triple(FlightPlan{}.start_m));
  }

  std::size_t size() const { return states_.size(); }

  py::array array_of_part(const py::object& self, const RowPart& part) {
    return part_of_rows(reinterpret_cast<double*>(states_.data()), states_.size(), sizeof(OneState), part, self);
  }

  /// Of all alike, or a row for each.
  py::array_t<double> hover_commands(const Triple& place_m) const {
    if (airframes_.size() == 1) return array_of(hover_of(vehicle_, place_m));
    py::array_t<double> rows({static_cast<py::ssize_t>(size()), static_cast<py::ssize_t>(rotor_count)});
    for (std::size_t i = 0; i < size(); ++i) {
      const Commands<double> commands = hover_of(with(airframes_[i].value), place_m);
      std::copy_n(commands.begin(), rotor_count, rows.mutable_data() + rotor_count * i);
    }
    return rows;
  }

  /// Level, at rest, the rotors in hover; those of a mask, or all.
  void reset(const py::object& which, const Triple& place_m) {
    require_idle();
    OneState hover;
    const Triple& place = checked("position_m", place_m);
    hover.body.position_m = Vector3<double>(place[0], place[1], place[2]);
    const std::vector<std::size_t> vehicles = chosen(which);
    if (airframes_.size() == 1) {
      hover.rotors = hover_of(vehicle_, place);
      for (const std::size_t i : vehicles) states_[i] = hover;
      return;
    }
    std::vector<Commands<double>> rotors;
    for (const std::size_t i : vehicles) rotors.push_back(hover_of(with(airframes_[i].value), place));
    for (std::size_t k = 0; k < vehicles.size(); ++k) {
      hover.rotors = rotors[k];
      states_[vehicles[k]] = hover;
    }
  }

  /// Other airframes for those of a mask, or all; states go on.
  void set_airframe(const py::object& airframe, const py::object& which) {
    require_idle();
    const std::vector<std::size_t> vehicles = chosen(which);
    const std::vector<NamedAirframe> given = airframes_of(airframe, vehicles.size());
    for (std::size_t k = 0; k < given.size(); ++k) {
      require_flying(with(given[k].value), given[k], given.size() > 1 ? vehicles[k] : no_vehicle);
    }
    if (given.size() == 1 && vehicles.size() == size()) {
      airframes_ = given;
      vehicle_ = with(given[0].value);
      put_in_lanes();
      return;
    }
    const bool alike = airframes_.size() < size();
    if (alike) airframes_.assign(size(), NamedAirframe(airframes_[0]));
    for (std::size_t k = 0; k < vehicles.size(); ++k) airframes_[vehicles[k]] = given[given.size() > 1 ? k : 0];
    if (alike || !lanes_) {
      put_in_lanes();
      return;
    }
    for (std::size_t k = 0; k < vehicles.size() && lanes_; ++k) {
      const std::size_t group = vehicles[k] / lanes_->lanes();
      if (k > 0 && vehicles[k - 1] / lanes_->lanes() == group) continue;
      put_in_lanes(group);
    }
  }

  py::array_t<std::uint8_t> step(const py::object& given, double seconds) {
    require_idle();
    const py::array_t<double> commands = doubles("commands", given);
    if (commands.ndim() != 2 || static_cast<std::size_t>(commands.shape(0)) != size() || commands.shape(1) != 4) {
      throw py::value_error("commands must be numbers of shape (" + std::to_string(size()) + ", 4), found " +
                            py::str(commands.attr("shape")).cast<std::string>());
    }
    const double steps = std::floor(checked("seconds", seconds, 0) / physics_step_s_ + 0.5);
    py::array_t<std::uint8_t> statuses(static_cast<py::ssize_t>(size()));
    const double* const u = commands.data();
    std::uint8_t* const said = statuses.mutable_data();
    const Busy busy(busy_);
    calls_python_ ? run_own(u, steps, said) : run_known(u, steps, said);
    return statuses;
  }

  py::tuple pickled(const py::object& self) {
    return py::make_tuple(airframe(), effects_, physics_step_s_, array_of_part(self, parts[0]));
  }
  static std::unique_ptr<Vehicles> of_pickle(const py::tuple& pickle) {
    const auto state = pickle[3].cast<py::array_t<double, py::array::c_style>>();
    if (state.ndim() != 2 || static_cast<std::size_t>(state.shape(1)) != state_numbers) {
      throw py::value_error("pickled vehicles have 19 numbers each");
    }
    const auto count = static_cast<std::size_t>(state.shape(0));
    auto vehicles = std::make_unique<Vehicles>(count, airframes_of(pickle[0], count), pickle[1].cast<py::object>(),
                                               pickle[2].cast<double>());
    std::copy_n(state.data(), state.size(), reinterpret_cast<double*>(vehicles->states_.data()));
    return vehicles;
  }

  /// As it was given: one, or a tuple of as many as there are vehicles.
  py::object airframe() const {
    if (airframes_.size() == 1) return py::cast(airframes_[0]);
    return py::tuple(py::cast(airframes_));
  }
  std::string airframe_name() const {
    return airframes_.size() == 1 ? printable(airframes_[0].name) : "an airframe each";
  }
  const py::object& effects() const { return effects_; }

 private:
  /// Changes that a force and a torque make in half a step.
  struct Push {
    Vector3<double> velocity_m_s, body_rates_rad_s;
  };

  std::vector<Push> pushes_of(const Vectors& forces, const Vectors& torques, double seconds) const {
    const auto payload_kg = effects_.attr("payload_kg").cast<double>();
    const auto payload_from_s = effects_.attr("payload_from_s").cast<double>();
    std::vector<Push> pushes(size());
    for (std::size_t i = 0; i < size(); ++i) {
      const Airframe<double>& airframe = airframe_of_one(i);
      const double mass_kg = airframe.mass_kg + (states_[i].time_s >= payload_from_s ? payload_kg : 0.0);
      pushes[i] = {forces[i] * (seconds / mass_kg), inertia_solved<double>(airframe, torques[i] * seconds)};
    }
    return pushes;
  }

  /// Of the callable of Python, in half a step; none without one.
  std::vector<Push> own_pushes() const {
    const py::handle called = std::get<Switched<OwnWrench, Usually::off>>(flown_).effect.called;
    if (!called) return {};
    py::array_t<double> motions({static_cast<py::ssize_t>(size()), static_cast<py::ssize_t>(motion_numbers)});
    double* row = motions.mutable_data();
    const FlownQuadrotor any = stepped_vehicle(0);  // the air is that of all
    const Vectors wind = own_wind(0);
    for (std::size_t i = 0; i < size(); ++i) {
      const OneState& state = states_[i];
      const Airframe<double>& airframe = airframe_of_one(i);
      ThrustFractions<double> thrusts{};
      for (std::size_t k = 0; k < rotor_count; ++k) {
        thrusts[k] = thrust_fraction(airframe.rotors[k].thrust_curve, state.rotors[k]);
      }
      const Surroundings<double> air = any.surroundings(state.body, state.time_s, {state.charge_used_C, thrusts});
      Vector3<double> through_air_m_s = state.body.velocity_m_s - air.wind_m_s;
      if (!wind.empty()) through_air_m_s -= wind[i];
      std::array<double, rotor_count> speeds_rev_s;
      for (std::size_t k = 0; k < rotor_count; ++k) {
        speeds_rev_s[k] = airframe.max_rotor_speed_rev_s * std::sqrt(std::max(0.0, thrusts[k] * air.thrust_scale));
      }
      write_motion(row, state.body.position_m, state.body.velocity_m_s, through_air_m_s, state.body.attitude,
                   state.body.body_rates_rad_s, speeds_rev_s, state.time_s);
      row += motion_numbers;
    }
    const auto [forces, torques] = wrenches_of(called, motions);
    return pushes_of(forces, torques, physics_step_s_ / 2);
  }

  /// The callable's wind in so many seconds; none without one.
  Vectors own_wind(double ahead_s) const {
    const py::handle called = std::get<Switched<OwnWind, Usually::off>>(flown_).effect.called;
    if (!called) return {};
    const auto rows = static_cast<py::ssize_t>(size());
    py::array_t<double> time_s(rows), position_m({rows, static_cast<py::ssize_t>(3)});
    for (std::size_t i = 0; i < size(); ++i) {
      const Vector3<double> place = states_[i].body.position_m + states_[i].body.velocity_m_s * ahead_s;
      time_s.mutable_data()[i] = states_[i].time_s + ahead_s;
      for (int axis = 0; axis < 3; ++axis)
        position_m.mutable_data()[3 * i + static_cast<std::size_t>(axis)] = place[axis];
    }
    return wind_of(called, time_s, position_m);
  }

  /// Steps with callables of Python, each asked once a step for all. A force acts for half of the step as it is at its
  /// start, for half as it is where that leads (Heun). A step in a wind is one in still air, seen by who drifts along.
  /// A vehicle whose step is refused stays as it was before that step. An exception leaves all as they were.
  void run_own(const double* u, double steps, std::uint8_t* said) {
    const std::vector<OneState> start = states_;
    try {
      step_own(u, steps, said);
    } catch (...) {
      states_ = start;
      throw;
    }
  }
  void step_own(const double* u, double steps, std::uint8_t* said) {
    std::fill_n(said, size(), static_cast<std::uint8_t>(Status::ok));
    std::vector<std::uint8_t> now(size());
    std::vector<Push> pushes = own_pushes();
    for (double done = 0; done < steps; ++done) {
      const std::vector<OneState> before = states_;
      const Vectors wind = own_wind(physics_step_s_ / 2);
      for (std::size_t i = 0; i < wind.size(); ++i) states_[i].body.velocity_m_s -= wind[i];
      push(pushes);
      run_known(u, 1, now.data());
      push(pushes);
      for (std::size_t i = 0; i < wind.size(); ++i) {
        states_[i].body.velocity_m_s += wind[i];
        states_[i].body.position_m += wind[i] * physics_step_s_;
      }
      std::vector<Push> later = own_pushes();
      for (std::size_t i = 0; i < later.size(); ++i) {
        states_[i].body.velocity_m_s += later[i].velocity_m_s - pushes[i].velocity_m_s;
        states_[i].body.body_rates_rad_s += later[i].body_rates_rad_s - pushes[i].body_rates_rad_s;
      }
      pushes = std::move(later);
      for (std::size_t i = 0; i < size(); ++i) {
        if (said[i] == 0) said[i] = now[i];
        if (said[i] != 0) states_[i] = before[i];
      }
    }
  }

  /// Steps with the effects of the library alone, without the GIL.
  void run_known(const double* u, double steps, std::uint8_t* said) {
    const py::gil_scoped_release without_gil;
    SignalWatch watch;
    if (lanes_) {
      run_in_lanes(u, steps, said, watch);
    } else {
      run(u, steps, said, watch);
    }
  }

  void push(const std::vector<Push>& pushes) {
    for (std::size_t i = 0; i < pushes.size(); ++i) {
      states_[i].body.velocity_m_s += pushes[i].velocity_m_s;
      states_[i].body.body_rates_rad_s += pushes[i].body_rates_rad_s;
    }
  }

  const Airframe<double>& airframe_of_one(std::size_t index) const {
    return airframes_[airframes_.size() == 1 ? 0 : index].value;
  }

  static constexpr auto no_vehicle = static_cast<std::size_t>(-1);

  /// The vehicle of another airframe.
  FlownQuadrotor with(const Airframe<double>& airframe) const {
    return quadrotor_with(flown_, airframe, vehicle_.site());
  }
  FlownQuadrotor stepped_vehicle(std::size_t index) const {
    return quadrotor_with(stepped_, airframe_of_one(index), vehicle_.site());
  }

  static void require_flying(const FlownQuadrotor& vehicle, const NamedAirframe& airframe, std::size_t index) {
    const Status status = vehicle.status();
    if (status == Status::ok) return;
    refuse((index == no_vehicle ? "" : "vehicle " + std::to_string(index) + ": ") + "airframe " +
           printable(airframe.name) + " with these effects: " + to_string(status));
  }

  static Commands<double> hover_of(const FlownQuadrotor& vehicle, const Triple& place_m) {
    Commands<double> hover{};
    const Status status = hover_trim(vehicle, Vector3<double>(place_m[0], place_m[1], place_m[2]), hover);
    throw_failure();
    if (status != Status::ok) refuse(std::string("no hover here: ") + to_string(status));
    return hover;
  }

  /// Where a mask is true; all for None.
  std::vector<std::size_t> chosen(const py::object& which) const {
    std::vector<std::size_t> vehicles;
    if (which.is_none()) {
      for (std::size_t i = 0; i < size(); ++i) vehicles.push_back(i);
      return vehicles;
    }
    const py::object plain = py::module_::import("pinnquad.arrays").attr("unmasked")("which", which);
    const auto mask = py::array_t<bool, py::array::c_style>::ensure(plain);
    if (!mask || mask.ndim() != 1 || static_cast<std::size_t>(mask.size()) != size()) {
      PyErr_Clear();
      throw py::value_error("which must be " + std::to_string(size()) + " truth values, one per vehicle");
    }
    for (std::size_t i = 0; i < size(); ++i) {
      if (mask.data()[i]) vehicles.push_back(i);
    }
    return vehicles;
  }

  /// All of them, where their rotors allow it.
  void put_in_lanes() {
    lanes_ = steps_in_lanes(vehicle_.site(), physics_step_s_, of_the_library(flown_));
    if (airframes_.size() == 1) {
      lanes_->set_airframe(airframes_[0].value);
      return;
    }
    for (std::size_t group = 0; lanes_ && group * lanes_->lanes() < size(); ++group) put_in_lanes(group);
  }
  void put_in_lanes(std::size_t group) {
    const std::size_t first = group * lanes_->lanes(), last = std::min(first + lanes_->lanes(), size());
    std::vector<Airframe<double>> values;
    for (std::size_t i = first; i < last; ++i) values.push_back(airframes_[i].value);
    if (!lanes_->set_airframes(group, values.data(), values.size())) lanes_.reset();
  }

  /// A vehicle whose step is refused stays as it was before that step.
  void run(const double* u, double steps, std::uint8_t* said, SignalWatch& watch) {
    const FlownQuadrotor first = stepped_vehicle(0);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Commands<double> commands = {u[4 * i], u[4 * i + 1], u[4 * i + 2], u[4 * i + 3]};
      const FlownQuadrotor vehicle = airframes_.size() == 1 ? first : stepped_vehicle(i);
      const auto step = vehicle.time_step(physics_step_s_);
      Status status = Status::ok;
      for (double done = 0; done < steps && status == Status::ok; ++done) {
        status = vehicle.step(states_[i], commands, step);
        if (std::fmod(done, 64) == 63) watch.look();
      }
      said[i] = static_cast<std::uint8_t>(status);
      if (i % 64 == 63) watch.look();
    }
  }

  /// The same, many at a time.
  void run_in_lanes(const double* u, double steps, std::uint8_t* said, SignalWatch& watch) {
    constexpr double steps_per_look = 64;
    const std::size_t vehicles_per_look = 8 * lanes_->lanes();
    auto* const states = reinterpret_cast<double*>(states_.data());
    if (steps < 1) std::fill_n(said, size(), static_cast<std::uint8_t>(Status::ok));
    for (std::size_t first = 0; first < size(); first += vehicles_per_look) {
      for (double left = steps; left > 0; left -= steps_per_look) {
        lanes_->step(states, u, first, std::min(first + vehicles_per_look, size()),
                     static_cast<std::uint64_t>(std::min(left, steps_per_look)), said);
        watch.look();
      }
    }
  }

  void require_idle() const {
    if (busy_) throw std::runtime_error("these vehicles are stepped in another thread");
  }

  std::vector<NamedAirframe> airframes_;  ///< one for all, or one for each
  py::object effects_;
  double physics_step_s_;
  FlownEffects flown_;      ///< the same, of all
  FlownEffects stepped_;    ///< those that steps know: none of Python's
  FlownQuadrotor vehicle_;  ///< the first, under all
  std::vector<OneState> states_;
  bool calls_python_;
  std::unique_ptr<VehicleSteps> lanes_;  ///< null where rotors are not those of lanes
  bool busy_ = false;
};

}  // namespace

void bind_vehicles(py::module_& module) {
  py::class_<Vehicles> vehicles(module, "Vehicles",
                                "Many vehicles under the same effects, stepped by one call. Their arrays are the "
                                "library's memory: to write to them places the vehicles.");
  vehicles
      .def(
          py::init([](std::size_t count, const py::object& airframe, const py::object& effects, double physics_step_s) {
            constexpr std::size_t most = 10'000'000;
            if (count < 1 || count > most) throw py::value_error("count must be 1 to " + std::to_string(most));
            const py::object chosen =
                effects.is_none() ? py::module_::import("pinnquad.effects").attr("Effects")() : effects;
            return new Vehicles(count, airframes_of(airframe, count), chosen, physics_step_s);
          }),
          py::arg("count").noconvert(), py::arg("airframe") = PaperQuadrotor::name, py::kw_only(),
          py::arg("effects") = py::none(), py::arg("physics_step_s") = FlightPlan{}.physics_step_s,
          "They begin in hover at (0, 0, -35) m, NED. The airframe is one for all, or a sequence of `count`, one each.")
      .def(
          "set_airframe", &Vehicles::set_airframe, py::arg("airframe"), py::arg("which") = py::none(),
          "Another airframe for all, or for those where `which` (truth values) says so: one, or a sequence of one for\n"
          "each of them. Their states go on.")
      .def("reset", &Vehicles::reset, py::arg("which") = py::none(),
           py::arg("position_m") = triple(FlightPlan{}.start_m),
           "Level, at rest, rotors in hover at a place, NED, m: all, or those where `which` (truth values) says so.")
      .def("step", &Vehicles::step, py::arg("commands"), py::arg("seconds") = FlightPlan{}.control_period_s(),
           "Holds the commands (vehicles x 4) for so long, in RK4 steps of physics_step_s. A\n"
           "Status per vehicle: one that is not ok leaves its vehicle before the step that was refused. The ground\n"
           "stops nobody: see Effects.ground_contact. Other threads run meanwhile. An exception of a callable of the\n"
           "effects comes through, and leaves all as they were before the call.")
      .def(
          "hover_commands",
          [](const Vehicles& self, const Triple& place_m) {
            return self.hover_commands(checked("position_m", place_m));
          },
          py::arg("position_m") = triple(FlightPlan{}.start_m),
          "The four commands of a hover at a place, NED, m; with an airframe each a row for each.")
      .def_property_readonly("airframe", &Vehicles::airframe, "A copy of it; of several a tuple.")
      .def_property_readonly("effects", &Vehicles::effects)
      .def("__len__", &Vehicles::size)
      .def("__repr__", [](const Vehicles& self) {
        return "<pinnquad.Vehicles: " + std::to_string(self.size()) + " of " + self.airframe_name() + ">";
      });
  pickled(
      vehicles, [](const py::object& self) { return self.cast<Vehicles&>().pickled(self); },
      [](const py::tuple& pickle) { return Vehicles::of_pickle(pickle); });
  for (const RowPart& part : parts) {
    vehicles.def_property_readonly(
        part.name, [&part](const py::object& self) { return self.cast<Vehicles&>().array_of_part(self, part); },
        part.doc);
  }
}

}  // namespace python
