// SPDX-License-Identifier: MIT
// The Python module pinnquad_sim: the simulator of simulation/simulator.hpp, whose parts Python chooses by name.
// A program's edge: names become types and values here, and only here. NED world, FRD body, SI units, radians.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/recorder.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/switchable_quadrotor.hpp"

namespace {

namespace py = pybind11;
using namespace pinnquad;

using Engine = std::mt19937_64;
using Triple = std::array<double, 3>;

/// Either of the pilots that Python can name.
struct ChosenPilot {
  std::variant<RandomPilot<Engine>, SteadyPilot> pilot;

  SetPoint<double> operator()(const State<double>& state, double time_s) {
    return std::visit([&](auto& chosen) -> SetPoint<double> { return chosen(state, time_s); }, pilot);
  }
};

using Vehicle = SwitchableQuadrotor<StandardAtmosphere, ConstantWind, PeriodicWind, QuadraticDrag>;
using Running = Simulator<Vehicle, ChosenPilot, NoisyRecorder<Engine>>;

PyObject* flight_ended = nullptr;  ///< the exception type FlightEnded; lives as long as the module

// ------------------------------------------------------------------------------------------------ names

constexpr std::array<std::pair<const char*, GroundEffectModel>, 3> ground_effect_models{{
    {"none", GroundEffectModel::none},
    {"cheeseman_bennett", GroundEffectModel::cheeseman_bennett},
    {"conyers", GroundEffectModel::conyers},
}};

std::vector<std::string> ground_effect_names() {
  std::vector<std::string> names;
  for (const auto& entry : ground_effect_models) names.emplace_back(entry.first);
  return names;
}

template <class... Vehicles>
std::array<std::pair<const char*, Airframe<double>>, sizeof...(Vehicles)> named_airframes() {
  return {{{Vehicles::name, airframe_value<Vehicles, double>()}...}};
}

/// The library's airframes by name.
const auto airframes =
    named_airframes<PaperQuadrotor, ReferenceQuadrotor10, ReferenceQuadrotor15, Crazyflie, Racer5Inch, Px4Sih>();

std::vector<std::string> airframe_names() {
  std::vector<std::string> names;
  for (const auto& entry : airframes) names.emplace_back(entry.first);
  return names;
}

[[noreturn]] void refuse_name(const char* what, const std::string& name, const std::vector<std::string>& known) {
  std::string text = "no " + std::string(what) + " named '" + name + "'; known: ";
  for (const std::string& one : known) text += (&one == &known.front() ? "" : ", ") + one;
  throw py::value_error(text);
}

GroundEffectModel ground_effect_named(const std::string& name) {
  for (const auto& [known, model] : ground_effect_models) {
    if (name == known) return model;
  }
  refuse_name("ground effect", name, ground_effect_names());
}

const char* name_of(GroundEffectModel model) {
  for (const auto& [name, known] : ground_effect_models) {
    if (model == known) return name;
  }
  return "unknown";
}

Airframe<double> airframe_named(const std::string& name) {
  for (const auto& [known, airframe] : airframes) {
    if (name == known) return airframe;
  }
  refuse_name("airframe", name, airframe_names());
}

// ------------------------------------------------------------------------------------------------ arguments

double checked(const char* name, double value, double least) {
  if (!(value >= least) || !is_finite(value)) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g", least);
    throw py::value_error(std::string(name) + " must be a finite number not below " + limit);
  }
  return value;
}

const Triple& checked(const char* name, const Triple& values) {
  for (const double value : values) {
    if (!is_finite(value)) throw py::value_error(std::string(name) + " must be three finite numbers");
  }
  return values;
}

// ------------------------------------------------------------------------------------------------ arrays

/// An array of its own memory, one row per sample; `row(sample)` gives the columns.
template <std::size_t Columns, class Row>
py::array_t<double> columns(const Flight& flight, const Row& row) {
  py::array_t<double> result({flight.size(), Columns});
  auto values = result.template mutable_unchecked<2>();
  for (std::size_t i = 0; i < flight.size(); ++i) {
    const auto numbers = row(flight[i]);
    for (std::size_t k = 0; k < Columns; ++k) {
      values(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = numbers[k];
    }
  }
  return result;
}

template <class Value>
py::array_t<double> column(const Flight& flight, const Value& value) {
  py::array_t<double> result(static_cast<py::ssize_t>(flight.size()));
  auto values = result.mutable_unchecked<1>();
  for (std::size_t i = 0; i < flight.size(); ++i) values(static_cast<py::ssize_t>(i)) = value(flight[i]);
  return result;
}

template <std::size_t Count>
py::array_t<double> array_of(const std::array<double, Count>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(Count), numbers.data());  // a copy
}
py::array_t<double> array_of(const Vector3<double>& v) { return array_of(Triple{v[0], v[1], v[2]}); }

Triple triple(const Vector3<double>& v) { return {v[0], v[1], v[2]}; }

py::dict arrays_of(const Flight& flight) {
  py::dict d;
  d["time_s"] = column(flight, [](const Sample& s) { return s.time_s; });
  d["linear_acceleration_m_s2"] =
      columns<3>(flight, [](const Sample& s) { return triple(s.linear_acceleration_m_s2); });
  d["angular_acceleration_rad_s2"] =
      columns<3>(flight, [](const Sample& s) { return triple(s.angular_acceleration_rad_s2); });
  d["velocity_m_s"] = columns<3>(flight, [](const Sample& s) { return triple(s.velocity_m_s); });
  d["body_rates_rad_s"] = columns<3>(flight, [](const Sample& s) { return triple(s.body_rates_rad_s); });
  d["euler_rad"] = columns<3>(flight, [](const Sample& s) { return Triple{s.roll_rad, s.pitch_rad, s.yaw_rad}; });
  d["altitude_m"] = column(flight, [](const Sample& s) { return s.altitude_m; });
  d["commands"] = columns<4>(flight, [](const Sample& s) { return s.commands; });
  return d;
}

// ------------------------------------------------------------------------------------------------ the simulator

struct Choices {
  std::string airframe, ground_effect, pilot;
  std::uint64_t seed;
  Triple wind, gust, start_m;
  double gust_period_s, max_speed_m_s;
  RecorderErrors errors;
};

Vehicle vehicle_of(const Choices& choices) {
  checked("wind", choices.wind);
  checked("gust", choices.gust);
  PeriodicWind gust;
  gust.mean_m_s = 0;
  gust.amplitude_m_s = std::hypot(choices.gust[0], choices.gust[1], choices.gust[2]);
  gust.period_s = checked("gust_period_s", choices.gust_period_s, 0.01);
  for (std::size_t i = 0; i < 3 && gust.amplitude_m_s > 0; ++i) {
    gust.direction[i] = choices.gust[i] / gust.amplitude_m_s;
  }
  Vehicle vehicle(airframe_named(choices.airframe), paper_site<double>(), {}, ConstantWind{choices.wind}, gust, {});
  vehicle.set_ground_effect(ground_effect_named(choices.ground_effect));
  return vehicle;
}

FlightPlan settings_of(const Choices& choices) {
  const Triple& start = checked("start_m", choices.start_m);
  FlightPlan settings;
  settings.start_m = Vector3<double>(start[0], start[1], start[2]);
  if (start[2] >= paper_site<double>().ground_z_m) {
    throw py::value_error("start_m must lie above the ground, which is at z = 0.877 m (NED: up is negative)");
  }
  return settings;
}

ChosenPilot pilot_of(const Choices& choices, const Vehicle& vehicle) {
  checked("max_speed_m_s", choices.max_speed_m_s, 0.5);
  if (choices.pilot == "hover") return {SteadyPilot{}};
  if (choices.pilot != "random") refuse_name("pilot", choices.pilot, {"random", "hover"});
  const Vector3<double> start = settings_of(choices).start_m;
  return {with_quadrotor(vehicle, [&](const auto& quadrotor) {
    return RandomPilot<Engine>(Engine(choices.seed), pilot_style(quadrotor, start, choices.max_speed_m_s),
                               quadrotor.site().ground_z_m);
  })};
}

/// The noise has an engine of its own: with and without noise the same seed flies the same flight.
NoisyRecorder<Engine> recorder_of(const Choices& choices) {
  constexpr std::uint64_t of_noise = 0x9e3779b97f4a7c15u;
  checked("gyro_noise_rad_s", choices.errors.gyro_noise_rad_s, 0);
  checked("derivative_interval_s", choices.errors.derivative_interval_s, 1e-6);
  checked("command_latency_s", choices.errors.command_latency_s, 0);
  checked("command_jitter_s", choices.errors.command_jitter_s, 0);
  return NoisyRecorder<Engine>(Engine(choices.seed ^ of_noise), choices.errors);
}

class PythonSimulator {
 public:
  explicit PythonSimulator(Choices choices) : choices_(std::move(choices)), running_(make(choices_)) {
    require_flying();
  }
  PythonSimulator(const PythonSimulator& other) : choices_(other.choices_), running_(other.idle().running_) {}
  PythonSimulator& operator=(const PythonSimulator&) = delete;

  void fly(double seconds) {
    run(seconds, [this] { return running_.tick(); });
  }

  void step(const py::array_t<double, py::array::c_style | py::array::forcecast>& commands, double seconds) {
    Commands<double> u{};
    if (commands.ndim() != 1 || static_cast<std::size_t>(commands.size()) != u.size()) {
      throw py::value_error("commands must be four numbers, one per rotor");
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = commands.at(static_cast<py::ssize_t>(i));
      if (!is_finite(u[i])) throw py::value_error("commands must be four finite numbers");
    }
    run(seconds, [this, u] { return running_.tick(u); });
  }

  void set_ground_effect(const std::string& name) { idle().running_.set_ground_effect(ground_effect_named(name)); }
  const char* ground_effect() const { return name_of(idle().running_.quadrotor().ground_effect()); }

  double time_s() const { return idle().running_.time_s(); }
  bool flying() const { return idle().running_.flying(); }

  py::array_t<double> hover_commands() const {
    Commands<double> commands{};
    const Status status = idle().running_.hover_commands(commands);
    if (status != Status::ok) throw std::runtime_error(std::string("no hover here: ") + to_string(status));
    return array_of(commands);
  }

  py::dict state() const {
    const VehicleState<double>& vehicle = idle().running_.vehicle();
    const State<double>& body = vehicle.body;
    const EulerAngles<double> euler = to_euler(body.attitude);
    py::dict d;
    d["time_s"] = vehicle.time_s;
    d["position_m"] = array_of(body.position_m);
    d["velocity_m_s"] = array_of(body.velocity_m_s);
    d["attitude"] = array_of(Commands<double>{body.attitude.w, body.attitude.x, body.attitude.y, body.attitude.z});
    d["euler_rad"] = array_of(Triple{euler.roll_rad, euler.pitch_rad, euler.yaw_rad});
    d["body_rates_rad_s"] = array_of(body.body_rates_rad_s);
    d["altitude_m"] = running_.altitude_m();
    d["commands"] = array_of(running_.commands());
    d["rotor_commands"] = array_of(vehicle.rotors);
    with_quadrotor(running_.quadrotor(), [&](const auto& quadrotor) {
      const auto loads = quadrotor.evaluate(body, vehicle.rotors, vehicle.time_s);
      d["rotor_thrust_N"] = -loads.rotors.force_N[2];
      d["aerodynamic_force_N"] = array_of(loads.aerodynamic.force_N);
      d["wind_m_s"] = array_of(loads.surroundings.wind_m_s);
    });
    return d;
  }

  py::dict recording() const { return arrays_of(idle().running_.recording()); }
  void clear_recording() { idle().running_.take_recording(); }
  std::size_t rows() const { return idle().running_.recording().size(); }

  void save_csv(const std::filesystem::path& path) const {
    write_flight_csv(path.string(), idle().running_.recording());
  }

  std::string text() const {
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, "%.3f s, %zu rows%s", time_s(), rows(), flying() ? "" : ", ended");
    return "<pinnquad_sim.Simulator " + choices_.airframe + ", seed " + std::to_string(choices_.seed) +
           ", ground effect " + ground_effect() + ": " + numbers + ">";
  }

 private:
  static Running make(const Choices& choices) {
    const Vehicle vehicle = vehicle_of(choices);
    return Running(vehicle, pilot_of(choices, vehicle), settings_of(choices), recorder_of(choices));
  }

  /// This simulator, if no other Python thread flies it; looked at and set only by who holds the GIL.
  const PythonSimulator& idle() const {
    if (busy_) throw std::runtime_error("this simulator is flying in another thread");
    return *this;
  }
  PythonSimulator& idle() {
    static_cast<const PythonSimulator&>(*this).idle();
    return *this;
  }

  /// `tick` for a duration, without the GIL; looks for Ctrl-C twenty times a second. An exception leaves the simulator
  /// at the tick it reached, and able to fly on.
  template <class Tick>
  void run(double seconds, const Tick& tick) {
    using Clock = std::chrono::steady_clock;
    constexpr auto between_looks = std::chrono::milliseconds(50);
    constexpr int ticks_per_look_at_the_clock = 64;
    checked("seconds", seconds, 0);
    idle();
    struct Busy {
      bool& flag;
      explicit Busy(bool& flag_) : flag(flag_) { flag = true; }
      ~Busy() { flag = false; }
    } const busy(busy_);
    {
      const py::gil_scoped_release without_gil;
      const double ticks = std::floor(seconds / running_.settings().control_period_s() + 0.5);
      auto next_look = Clock::now() + between_looks;
      int since_look = 0;
      for (double done = 0; done < ticks && tick(); ++done) {
        if (++since_look < ticks_per_look_at_the_clock) continue;
        since_look = 0;
        if (Clock::now() < next_look) continue;
        const py::gil_scoped_acquire with_gil;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        next_look = Clock::now() + between_looks;
      }
    }
    require_flying();
  }

  /// Throws FlightEnded, with time, state and reason, if the flight has ended.
  void require_flying() const {
    if (running_.flying()) return;
    const State<double>& body = running_.vehicle().body;
    const char* reason =
        running_.end() == FlightEnd::ground ? "it came down to the ground" : to_string(running_.status());
    char text[256];
    std::snprintf(text, sizeof text,
                  "the flight ended at %.3f s, north %.2f m, east %.2f m, %.2f m above ground, at %.2f m/s: %s",
                  running_.time_s(), body.position_m[0], body.position_m[1], running_.altitude_m(),
                  body.velocity_m_s.norm(), reason);
    const py::object error = py::reinterpret_borrow<py::object>(flight_ended)(text);
    error.attr("time_s") = running_.time_s();
    error.attr("altitude_m") = running_.altitude_m();
    error.attr("position_m") = array_of(body.position_m);
    error.attr("velocity_m_s") = array_of(body.velocity_m_s);
    error.attr("reason") = reason;
    PyErr_SetObject(flight_ended, error.ptr());
    throw py::error_already_set();
  }

  Choices choices_;
  Running running_;
  bool busy_{false};
};

}  // namespace

PYBIND11_MODULE(pinnquad_sim, module) {
  module.doc() =
      "A quadrotor simulator: rigid body, rotors with lag, drag, wind, air density and ground effect (pinnquad).\n\n"
      "World NED, body FRD, SI units, radians. Rotors: front right, rear left, front left, rear right; a command is "
      "0..1,\n"
      "thrust is proportional to it. The same seed gives the same flight, bit for bit.";

  flight_ended = PyErr_NewExceptionWithDoc("pinnquad_sim.FlightEnded",
                                           "The flight has ended: the ground, or a step that cannot be calculated. "
                                           "Attributes: time_s, altitude_m, position_m\n"
                                           "and velocity_m_s (NED), reason. The recording up to there is kept.",
                                           PyExc_RuntimeError, nullptr);
  module.add_object("FlightEnded", flight_ended);

  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const OutputError& error) {
      PyErr_SetString(PyExc_OSError, error.what());
    }
  });

  module.def("airframes", &airframe_names, "Names of the airframes that Simulator knows.");
  module.def("ground_effects", &ground_effect_names, "Names of the ground effect models that Simulator knows.");

  const PilotStyle style;
  const FlightPlan settings;
  const RecorderErrors no_errors;
  py::class_<PythonSimulator>(
      module, "Simulator", "A running simulation. It starts at start_m (NED) in hover; a row is recorded every 0.05 s.")
      .def(py::init([](const std::string& airframe, std::uint64_t seed, const std::string& ground_effect,
                       const std::string& pilot, const Triple& wind, const Triple& gust, double gust_period_s,
                       const Triple& start_m, double max_speed_m_s, double gyro_noise_rad_s,
                       double derivative_interval_s, double command_latency_s, double command_jitter_s) {
             RecorderErrors errors;
             errors.gyro_noise_rad_s = gyro_noise_rad_s;
             errors.derivative_interval_s = derivative_interval_s;
             errors.command_latency_s = command_latency_s;
             errors.command_jitter_s = command_jitter_s;
             return new PythonSimulator(
                 {airframe, ground_effect, pilot, seed, wind, gust, start_m, gust_period_s, max_speed_m_s, errors});
           }),
           py::arg("airframe") = PaperQuadrotor::name, py::arg("seed") = 1, py::arg("ground_effect") = "none",
           py::kw_only(), py::arg("pilot") = "random", py::arg("wind") = Triple{}, py::arg("gust") = Triple{},
           py::arg("gust_period_s") = PeriodicWind{}.period_s, py::arg("start_m") = triple(settings.start_m),
           py::arg("max_speed_m_s") = style.max_speed_m_s, py::arg("gyro_noise_rad_s") = no_errors.gyro_noise_rad_s,
           py::arg("derivative_interval_s") = no_errors.derivative_interval_s,
           py::arg("command_latency_s") = no_errors.command_latency_s,
           py::arg("command_jitter_s") = no_errors.command_jitter_s,
           "airframe        one of airframes()\n"
           "seed            of the random pilot and, apart from it, of the recorder's noise\n"
           "ground_effect   one of ground_effects(); set_ground_effect changes it in flight\n"
           "pilot           'random': agile, 10 to 60 m above ground; 'hover': stands still\n"
           "wind            NED, m/s; gust adds gust * sin(2 pi t / gust_period_s). The paper's D3:\n"
           "                wind=(2.5, 0, 0), gust=(2.5, 0, 0), gust_period_s=10\n"
           "start_m         NED; the ground is at z = 0.877 m\n"
           "max_speed_m_s   that the random pilot asks for\n"
           "gyro_noise_rad_s, derivative_interval_s, command_latency_s, command_jitter_s\n"
           "                errors of the recording only (docs/simulator.md)\n\n"
           "ValueError for an unknown name or a value that makes no sense; FlightEnded where no hover is possible.")
      .def("fly", &PythonSimulator::fly, py::arg("seconds"),
           "Flies on as the pilot wants, for so many seconds (rounded to ticks of 2 ms). Other Python threads run\n"
           "meanwhile; Ctrl-C stops it at a tick. FlightEnded at the ground or where a step cannot be calculated.")
      .def("step", &PythonSimulator::step, py::arg("commands"), py::arg("seconds") = settings.control_period_s(),
           "Flies on with these four motor commands instead of the pilot's; else as fly.")
      .def("set_ground_effect", &PythonSimulator::set_ground_effect, py::arg("name"),
           "From the next tick on the vehicle flies with this ground effect, one of ground_effects().")
      .def_property_readonly("ground_effect", &PythonSimulator::ground_effect, "The present ground effect's name.")
      .def_property_readonly("time_s", &PythonSimulator::time_s, "Seconds flown since the start.")
      .def_property_readonly("flying", &PythonSimulator::flying, "False once the flight has ended.")
      .def_property_readonly("rows", &PythonSimulator::rows, "Rows recorded, those forgotten left out.")
      .def_property_readonly(
          "state", &PythonSimulator::state,
          "The true state now, a dict: time_s, position_m and velocity_m_s (NED), attitude (w, x, y, z: body to "
          "world),\n"
          "euler_rad (roll, pitch, yaw), body_rates_rad_s, altitude_m above ground, commands (last told to the motors, "
          "not\n"
          "clipped), rotor_commands (behind the rotors' lag), rotor_thrust_N (along body -z, without ground effect),\n"
          "aerodynamic_force_N (body: drag and ground effect), wind_m_s (NED).")
      .def("hover_commands", &PythonSimulator::hover_commands,
           "The four commands of a hover at the present place and time, through wind and ground effect; not clipped.")
      .def("recording", &PythonSimulator::recording,
           "The rows so far, a dict of NumPy arrays that own their memory, N rows each: time_s,\n"
           "linear_acceleration_m_s2 (N x 3, derivative of the body-frame velocity), angular_acceleration_rad_s2 (N x "
           "3),\n"
           "velocity_m_s (N x 3, body frame), body_rates_rad_s (N x 3), euler_rad (N x 3), altitude_m, commands (N x "
           "4).")
      .def("clear_recording", &PythonSimulator::clear_recording, "Forgets the rows so far; the flight goes on.")
      .def("save_csv", &PythonSimulator::save_csv, py::arg("path"),
           "Writes the rows as `pinnquad fly` does. OSError if that is not possible.")
      .def(
          "copy", [](const PythonSimulator& self) { return new PythonSimulator(self); },
          "A simulator that flies on from here like this one, and apart from it.")
      .def("__repr__", &PythonSimulator::text);
}
