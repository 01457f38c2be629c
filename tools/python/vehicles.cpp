// SPDX-License-Identifier: MIT
// Many vehicles of one airframe, stepped by one call. Their states are one array, where they lie.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/core/processor.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "python/effects.hpp"
#include "python/vehicle_steps.hpp"

namespace python {

namespace {

using namespace pinnquad;
using OneState = VehicleState<double>;

static_assert(sizeof(OneState) == state_numbers * sizeof(double),
              "pinnquad: vehicles are shown to Python as rows of 18 numbers");

#if defined(PINNQUAD_STEPS_IN_LANES)
/// The fastest that runs here, or null.
const CompiledSteps* steps_in_lanes() {
  static const CompiledSteps* const chosen = []() -> const CompiledSteps* {
    for (const CompiledSteps* candidate : {&steps_avx512, &steps_avx2}) {
      if (runs_on_this_processor(candidate->instruction_set)) return candidate;
    }
    return nullptr;
  }();
  return chosen;
}
#else
const CompiledSteps* steps_in_lanes() { return nullptr; }
#endif

/// Parts of a state.
constexpr std::array<RowPart, 7> parts = {
    {{"state", 0, state_numbers, "All numbers, vehicles x 18: those below in this order. To be written to, too."},
     {"position_m", 0, 3, "NED, m; the ground is at z = 0.877 m."},
     {"velocity_m_s", 3, 3, "NED, m/s."},
     {"attitude", 6, 4, "Unit quaternions w, x, y, z, body to world."},
     {"body_rates_rad_s", 10, 3, "p, q, r, FRD, rad/s."},
     {"rotor_commands", 13, 4, "Commands at which the present thrusts would be settled, behind the lag."},
     {"time_s", 17, 1, "Of each vehicle, s: for gusts, battery, faults."}}};

class Vehicles {
 public:
  Vehicles(std::size_t count, const NamedAirframe& airframe, const py::object& effects, double physics_step_s)
      : airframe_(airframe),
        effects_(effects),
        physics_step_s_(checked("physics_step_s", physics_step_s, 1e-6)),
        vehicle_(vehicle_of(airframe, effects_of(effects))),
        states_(count) {
    if (steps_in_lanes() != nullptr && vehicle_.paper_effects() != nullptr) {
      lanes_ = steps_in_lanes()->of(vehicle_.airframe(), vehicle_.site(), *vehicle_.paper_effects(),
                                    vehicle_.ground_effect(), physics_step_s_);
    }
    reset(py::none(), triple(FlightPlan{}.start_m));
  }

  std::size_t size() const { return states_.size(); }

  py::array array_of_part(const py::object& self, const RowPart& part) {
    return part_of_rows(reinterpret_cast<double*>(states_.data()), states_.size(), sizeof(OneState), part, self);
  }

  Commands<double> hover_commands(const Triple& place_m) const {
    HoverTrim<double> hover;
    const Status status = with_quadrotor(vehicle_, [&](const auto& quadrotor) {
      return hover_trim(quadrotor, Vector3<double>(place_m[0], place_m[1], place_m[2]), hover);
    });
    if (status != Status::ok) refuse(std::string("no hover here: ") + to_string(status));
    return hover.commands;
  }

  /// Level, at rest, the rotors in hover; those of a mask, or all.
  void reset(const py::object& which, const Triple& place_m) {
    require_idle();
    OneState hover;
    const Triple& place = checked("position_m", place_m);
    hover.body.position_m = Vector3<double>(place[0], place[1], place[2]);
    hover.rotors = hover_commands(place);
    if (which.is_none()) {
      std::fill(states_.begin(), states_.end(), hover);
      return;
    }
    const auto mask = py::array_t<bool, py::array::c_style>::ensure(which);
    if (!mask || mask.ndim() != 1 || static_cast<std::size_t>(mask.size()) != size()) {
      PyErr_Clear();
      throw py::value_error("which must be " + std::to_string(size()) + " truth values, one per vehicle");
    }
    for (std::size_t i = 0; i < size(); ++i) {
      if (mask.data()[i]) states_[i] = hover;
    }
  }

  py::array_t<std::uint8_t> step(const py::array& commands, double seconds) {
    require_idle();
    if (!py::isinstance<py::array_t<double>>(commands) || commands.ndim() != 2 ||
        static_cast<std::size_t>(commands.shape(0)) != size() || commands.shape(1) != 4) {
      throw py::value_error("commands must be float64 of shape (" + std::to_string(size()) + ", 4), found " +
                            py::str(commands.dtype()).cast<std::string>() + " of " +
                            py::str(commands.attr("shape")).cast<std::string>());
    }
    if ((commands.flags() & py::array::c_style) == 0) {
      throw py::value_error("commands must be C-contiguous; numpy.ascontiguousarray() makes them so");
    }
    const double steps = std::floor(checked("seconds", seconds, 0) / physics_step_s_ + 0.5);
    py::array_t<std::uint8_t> statuses(static_cast<py::ssize_t>(size()));
    const auto* u = static_cast<const double*>(commands.data());
    std::uint8_t* const said = statuses.mutable_data();
    {
      const Busy busy(busy_);
      const py::gil_scoped_release without_gil;
      SignalWatch watch;
      if (lanes_) {
        run_in_lanes(u, steps, said, watch);
      } else {
        with_quadrotor(vehicle_, [&](const auto& quadrotor) { run(quadrotor, u, steps, said, watch); });
      }
    }
    return statuses;
  }

  py::tuple pickled(const py::object& self) {
    return py::make_tuple(airframe_, effects_, physics_step_s_, array_of_part(self, parts[0]));
  }
  static std::unique_ptr<Vehicles> of_pickle(const py::tuple& pickle) {
    const auto state = pickle[3].cast<py::array_t<double, py::array::c_style>>();
    if (state.ndim() != 2 || static_cast<std::size_t>(state.shape(1)) != state_numbers) {
      throw py::value_error("pickled vehicles have 18 numbers each");
    }
    auto vehicles =
        std::make_unique<Vehicles>(static_cast<std::size_t>(state.shape(0)), pickle[0].cast<NamedAirframe>(),
                                   pickle[1].cast<py::object>(), pickle[2].cast<double>());
    std::copy_n(state.data(), state.size(), reinterpret_cast<double*>(vehicles->states_.data()));
    return vehicles;
  }

  const NamedAirframe& airframe() const { return airframe_; }
  const py::object& effects() const { return effects_; }

 private:
  /// A vehicle whose step is refused stays as it was before that step.
  template <class Quadrotor>
  void run(const Quadrotor& quadrotor, const double* u, double steps, std::uint8_t* said, SignalWatch& watch) {
    const auto step = quadrotor.time_step(physics_step_s_);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Commands<double> commands = {u[4 * i], u[4 * i + 1], u[4 * i + 2], u[4 * i + 3]};
      Status status = Status::ok;
      for (double done = 0; done < steps && status == Status::ok; ++done) {
        status = quadrotor.step(states_[i], commands, step);
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

  NamedAirframe airframe_;
  py::object effects_;
  double physics_step_s_;
  SwitchedQuadrotor vehicle_;
  std::vector<OneState> states_;
  std::unique_ptr<VehicleSteps> lanes_;  ///< null where effects or processor are not those of lanes
  bool busy_ = false;
};

}  // namespace

VehicleSteps::~VehicleSteps() = default;

void bind_vehicles(py::module_& module) {
  py::class_<Vehicles> vehicles(module, "Vehicles",
                                "Many vehicles of one airframe under the same effects, stepped by one call. Their "
                                "arrays are the library's memory: to write to them places the vehicles.");
  vehicles
      .def(
          py::init([](std::size_t count, const py::object& airframe, const py::object& effects, double physics_step_s) {
            constexpr std::size_t most = 10'000'000;
            if (count < 1 || count > most) throw py::value_error("count must be 1 to " + std::to_string(most));
            const py::object chosen =
                effects.is_none() ? py::module_::import("pinnquad.effects").attr("Effects")() : effects;
            return new Vehicles(count, airframe_of(airframe), chosen, physics_step_s);
          }),
          py::arg("count"), py::arg("airframe") = PaperQuadrotor::name, py::kw_only(), py::arg("effects") = py::none(),
          py::arg("physics_step_s") = FlightPlan{}.physics_step_s, "They begin in hover at (0, 0, -35) m, NED.")
      .def("reset", &Vehicles::reset, py::arg("which") = py::none(),
           py::arg("position_m") = triple(FlightPlan{}.start_m),
           "Level, at rest, rotors in hover at a place, NED, m: all, or those where `which` (truth values) says so.")
      .def("step", &Vehicles::step, py::arg("commands"), py::arg("seconds") = FlightPlan{}.control_period_s(),
           "Holds the commands (vehicles x 4, float64, C-contiguous) for so long, in RK4 steps of physics_step_s. A\n"
           "Status per vehicle: one that is not ok leaves its vehicle before the step that was refused. The ground\n"
           "stops nobody: see Effects.ground_contact. Other threads run meanwhile.")
      .def(
          "hover_commands",
          [](const Vehicles& self, const Triple& place_m) {
            return array_of(self.hover_commands(checked("position_m", place_m)));
          },
          py::arg("position_m") = triple(FlightPlan{}.start_m), "The four commands of a hover at a place, NED, m.")
      .def_property_readonly("airframe", &Vehicles::airframe, py::return_value_policy::copy, "A copy of it.")
      .def_property_readonly("effects", &Vehicles::effects)
      .def("__len__", &Vehicles::size)
      .def("__repr__", [](const Vehicles& self) {
        return "<pinnquad.Vehicles: " + std::to_string(self.size()) + " of " + printable(self.airframe().name) + ">";
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
