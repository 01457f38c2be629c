// SPDX-License-Identifier: MIT
// The simulator of simulation/simulator.hpp: airframe, effects and pilot are chosen in Python, effects also in flight.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "command_line/in_words.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/recorder.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "python/effects.hpp"

namespace python {

namespace {

using namespace pinnquad;
using Engine = std::mt19937_64;

/// A callable of Python: pilot(time_s, position_m, velocity_m_s) gives the velocity wanted (NED), or it and a yaw rate.
struct CalledPilot {
  py::object pilot;

  SetPoint<double> operator()(const State<double>& state, double time_s) const {
    const py::gil_scoped_acquire with_gil;
    const py::object wanted = pilot(time_s, array_of(state.position_m), array_of(state.velocity_m_s));
    SetPoint<double> result;
    try {
      const bool with_yaw = py::isinstance<py::tuple>(wanted) && py::len(wanted) == 2;
      const auto velocity = (with_yaw ? py::object(wanted[py::int_(0)]) : wanted).cast<Triple>();
      if (with_yaw) result.yaw_rate_rad_s = wanted[py::int_(1)].cast<double>();
      result.velocity_m_s = Vector3<double>(velocity[0], velocity[1], velocity[2]);
      checked("pilot: its velocity", velocity);
      checked("pilot: its yaw rate", std::abs(result.yaw_rate_rad_s), 0);
    } catch (const py::cast_error&) {
      throw py::type_error("pilot: expected a velocity (three numbers, NED, m/s) or (velocity, yaw rate), found " +
                           py::repr(wanted).cast<std::string>());
    }
    return result;
  }
};

/// One of the pilots that Python can name, or a callable.
struct ChosenPilot {
  std::variant<RandomPilot<Engine>, NearGroundPilot<Engine>, SteadyPilot, CalledPilot> pilot;

  SetPoint<double> operator()(const State<double>& state, double time_s) {
    return std::visit([&](auto& chosen) -> SetPoint<double> { return chosen(state, time_s); }, pilot);
  }
};

constexpr std::array<const char*, 3> pilots = {"random", "near_ground", "hover"};
using Running = Simulator<FlownQuadrotor, ChosenPilot, NoisyRecorder<Engine>>;

/// Of a simulator as it began.
struct Choices {
  NamedAirframe airframe;
  std::uint64_t seed;
  FlownEffects effects;
  py::object effects_of_python;
  py::object pilot;  ///< its name, or a callable
  Triple start_m;
  double max_speed_m_s;
  RecorderErrors errors;
};

FlightPlan plan_of(const Choices& choices) {
  const Triple& start = checked("start_m", choices.start_m);
  FlightPlan plan;
  plan.start_m = Vector3<double>(start[0], start[1], start[2]);
  if (start[2] >= paper_site<double>().ground_z_m) {
    throw py::value_error("start_m must lie above the ground, which is at z = 0.877 m (NED: up is negative)");
  }
  return plan;
}

ChosenPilot pilot_of(const Choices& choices, const FlownQuadrotor& vehicle) {
  checked("max_speed_m_s", choices.max_speed_m_s, 0.5);
  if (!py::isinstance<py::str>(choices.pilot)) {
    if (PyCallable_Check(choices.pilot.ptr()) == 0) throw py::type_error("pilot must be a name or a callable");
    return {CalledPilot{choices.pilot}};
  }
  const auto name = choices.pilot.cast<std::string>();
  if (name == "hover") return {SteadyPilot{}};
  const Vector3<double> start = plan_of(choices).start_m;
  const double ground_z_m = vehicle.site().ground_z_m;
  if (name == "random") {
    return {RandomPilot<Engine>(Engine(choices.seed), pilot_style(vehicle, start, choices.max_speed_m_s), ground_z_m)};
  }
  if (name == "near_ground") {
    return {NearGroundPilot<Engine>(Engine(choices.seed), near_ground_style(vehicle, start, choices.max_speed_m_s),
                                    ground_z_m)};
  }
  refuse_name("pilot", name, pilots);
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
  explicit PythonSimulator(Choices choices) : choices_(std::move(choices)), running_(made(choices_)) {
    throw_failure();
    require_flying();
  }
  PythonSimulator(const PythonSimulator& other)
      : choices_(other.idle().choices_), running_(other.running_), journal_(other.journal_) {}
  PythonSimulator& operator=(const PythonSimulator&) = delete;

  void fly(double seconds) {
    run(seconds, {}, [this] { return running_.tick(); });
  }

  void step(const py::object& given, double seconds) {
    const py::array_t<double> commands = doubles("commands", given);
    Commands<double> u{};
    if (commands.ndim() != 1 || static_cast<std::size_t>(commands.size()) != u.size()) {
      throw py::value_error("commands must be four numbers, one per rotor");
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = commands.at(static_cast<py::ssize_t>(i));
      if (!is_finite(u[i])) throw py::value_error("commands must be four finite numbers");
    }
    run(seconds, u, [this, u] { return running_.tick(u); });
  }

  const NamedAirframe& airframe() const { return choices_.airframe; }
  py::object effects() const { return idle().choices_.effects_of_python; }
  void set_effects(const py::object& effects) {
    const FlownEffects flown = effects_of(effects);
    const FlownQuadrotor vehicle = vehicle_of(choices_.airframe, flown);
    idle().running_.set_quadrotor(vehicle);
    choices_.effects = flown;
    choices_.effects_of_python = effects;
    journal_.push_back({0, {}, effects});
  }

  double time_s() const { return idle().running_.time_s(); }
  bool flying() const { return idle().running_.flying(); }

  py::array_t<double> hover_commands() const {
    Commands<double> commands{};
    const Status status = idle().running_.hover_commands(commands);
    throw_failure();
    if (status != Status::ok) refuse(std::string("no hover here: ") + to_string(status));
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
    const auto loads = running_.quadrotor().evaluate(vehicle);
    throw_failure();
    d["rotor_thrust_N"] = -loads.rotors.force_N[2];
    d["aerodynamic_force_N"] = array_of(loads.aerodynamic.force_N);
    d["wind_m_s"] = array_of(loads.surroundings.wind_m_s);
    d["air_density_kg_m3"] = loads.surroundings.air_density_kg_m3;
    d["thrust_scale"] = loads.surroundings.thrust_scale;
    d["battery_voltage_V"] = loads.surroundings.battery.voltage_V;
    d["battery_current_A"] = loads.surroundings.battery.current_A;
    d["charge_used_C"] = vehicle.charge_used_C;
    return d;
  }

  std::shared_ptr<Flight> recording() const { return named(idle().running_.recording()); }
  std::shared_ptr<Flight> take_recording() {
    Flight taken = idle().running_.take_recording();
    throw_failure();
    journal_.push_back({0, {}, py::none()});
    return named(std::move(taken));
  }
  std::size_t rows() const { return idle().running_.recording().size(); }

  /// State of a pickle: the choices at the start, and what was done since. The same seed gives the same bits.
  py::tuple journal() const {
    const RecorderErrors& e = idle().choices_.errors;
    py::list done;
    for (const Deed& deed : journal_) done.append(py::make_tuple(deed.ticks, deed.commands, deed.effects));
    return py::make_tuple(choices_.airframe, choices_.seed, begun_with_, choices_.pilot, choices_.start_m,
                          choices_.max_speed_m_s, e.gyro_noise_rad_s, e.derivative_interval_s, e.command_latency_s,
                          e.command_jitter_s, done);
  }
  static PythonSimulator of_journal(const py::tuple& state) {
    RecorderErrors errors;
    errors.gyro_noise_rad_s = state[6].cast<double>();
    errors.derivative_interval_s = state[7].cast<double>();
    errors.command_latency_s = state[8].cast<double>();
    errors.command_jitter_s = state[9].cast<double>();
    PythonSimulator simulator({state[0].cast<NamedAirframe>(), state[1].cast<std::uint64_t>(), effects_of(state[2]),
                               state[2].cast<py::object>(), state[3].cast<py::object>(), state[4].cast<Triple>(),
                               state[5].cast<double>(), errors});
    for (const py::handle done : state[10]) {
      const auto deed = done.cast<std::tuple<std::uint64_t, std::optional<Commands<double>>, py::object>>();
      simulator.repeat({std::get<0>(deed), std::get<1>(deed), std::get<2>(deed)});
    }
    return simulator;
  }

  std::string text() const {
    return "<pinnquad.Simulator " + printable(choices_.airframe.name) + ", seed " + std::to_string(choices_.seed) +
           programs::in_words(": %.3f s, %zu rows%s>", time_s(), rows(), flying() ? "" : ", ended");
  }

 private:
  /// Ticks under the pilot or under commands; without ticks other effects, or None for a recording that was taken.
  struct Deed {
    std::uint64_t ticks = 0;
    std::optional<Commands<double>> commands;
    py::object effects;
  };

  static Running made(const Choices& choices) {
    const FlownQuadrotor vehicle = vehicle_of(choices.airframe, choices.effects);
    return Running(vehicle, pilot_of(choices, vehicle), plan_of(choices), recorder_of(choices));
  }

  std::shared_ptr<Flight> named(Flight flight) const {
    flight.name = choices_.airframe.name + ", seed " + std::to_string(choices_.seed);
    return std::make_shared<Flight>(std::move(flight));
  }

  /// This simulator, if no other Python thread flies it.
  const PythonSimulator& idle() const {
    if (busy_) throw std::runtime_error("this simulator is flying in another thread");
    return *this;
  }
  PythonSimulator& idle() {
    static_cast<const PythonSimulator&>(*this).idle();
    return *this;
  }

  void note(std::uint64_t ticks, const std::optional<Commands<double>>& commands) {
    if (ticks == 0) return;
    if (!journal_.empty() && journal_.back().ticks > 0 && journal_.back().commands == commands) {
      journal_.back().ticks += ticks;
    } else {
      journal_.push_back({ticks, commands, py::none()});
    }
  }

  void repeat(const Deed& deed) {
    if (deed.ticks == 0) {
      deed.effects.is_none() ? static_cast<void>(take_recording()) : set_effects(deed.effects);
      return;
    }
    std::uint64_t left = deed.ticks;
    while (left-- > 0 && !failed()) deed.commands ? running_.tick(*deed.commands) : running_.tick();
    throw_failure();
    note(deed.ticks, deed.commands);
  }

  /// `tick` for a duration, without the GIL. An exception leaves the simulator at the tick it reached, able to fly on;
  /// one of an effect's callable, which a step asks on its way, where it was before.
  template <class Tick>
  void run(double seconds, const std::optional<Commands<double>>& commands, const Tick& tick) {
    constexpr std::uint64_t ticks_per_look = 64;
    checked("seconds", seconds, 0);
    idle();
    require_flying();
    std::uint64_t done = 0;
    std::optional<Running> before;
    if (calls_python(choices_.effects)) before = running_;
    {
      const Busy busy(busy_);
      const struct Noted {
        PythonSimulator& self;
        const std::optional<Commands<double>>& commands;
        std::uint64_t& done;
        ~Noted() { self.note(done, commands); }
      } noted{*this, commands, done};
      const py::gil_scoped_release without_gil;
      SignalWatch watch;
      const double ticks = std::floor(seconds / running_.settings().control_period_s() + 0.5);
      bool flies = true;
      while (flies && static_cast<double>(done) < ticks) {
        flies = tick();
        if (++done % ticks_per_look == 0) watch.look();
      }
      if (failed()) done = 0;
    }
    if (failed()) running_ = std::move(*before);
    throw_failure();
    require_flying();
  }

  /// Throws FlightEnded, with time, state and reason, if the flight has ended.
  void require_flying() const {
    if (running_.flying()) return;
    const State<double>& body = running_.vehicle().body;
    const char* reason =
        running_.end() == FlightEnd::ground ? "it came down to the ground" : to_string(running_.status());
    const std::string text = programs::in_words(
        "the flight ended at %.3f s, north %.2f m, east %.2f m, %.2f m above ground, at %.2f m/s: %s",
        running_.time_s(), body.position_m[0], body.position_m[1], running_.altitude_m(), body.velocity_m_s.norm(),
        reason);
    const py::object error = py::reinterpret_borrow<py::object>(flight_ended_type())(text);
    error.attr("time_s") = running_.time_s();
    error.attr("altitude_m") = running_.altitude_m();
    error.attr("position_m") = array_of(body.position_m);
    error.attr("velocity_m_s") = array_of(body.velocity_m_s);
    error.attr("reason") = reason;
    PyErr_SetObject(flight_ended_type().ptr(), error.ptr());
    throw py::error_already_set();
  }

  Choices choices_;
  py::object begun_with_ = choices_.effects_of_python;
  Running running_;
  std::vector<Deed> journal_;
  bool busy_ = false;
};

/// A field of the Effects of Python. Throws TypeError that names it.
template <class Value>
void take(py::handle effects, const char* name, Value& value) {
  const py::object given = effects.attr(name);
  try {
    value = given.cast<Value>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string("effects: ") + name + " can't be " + py::repr(given).cast<std::string>());
  }
}

/// The same of a whole number: pybind11 would take 2.7 of NumPy as 2.
template <class Value>
void take_whole(py::handle effects, const char* name, Value& value) {
  py::module_::import("pinnquad.arrays").attr("whole")(std::string("effects: ") + name, effects.attr(name));
  take(effects, name, value);
}

}  // namespace

FlownEffects effects_of(py::handle given) {
  if (!py::isinstance(given, py::module_::import("pinnquad.effects").attr("Effects"))) {
    throw py::type_error("effects must be pinnquad.Effects, found " +
                         py::repr(py::type::of(given)).cast<std::string>());
  }
  const auto number = [given](const char* name, double least) {
    double value = 0;
    take(given, name, value);
    return checked(name, value, least);
  };
  const auto vector = [given](const char* name) {
    Triple value{};
    take(given, name, value);
    return checked(name, value);
  };
  const auto is_on = [given](const char* name) {
    bool on = false;
    take(given, name, on);
    return on;
  };
  const auto called = [given](const char* name) {  // null unless it is a callable
    const py::object value = given.attr(name);
    return PyCallable_Check(value.ptr()) != 0 ? value.ptr() : nullptr;
  };
  const OwnWind own_wind{called("wind_m_s")};
  const OwnWrench own_wrench{called("wrench")};
  if (own_wrench.called == nullptr && !given.attr("wrench").is_none()) {
    throw py::type_error("effects: wrench must be a callable or None, found " +
                         py::repr(given.attr("wrench")).cast<std::string>());
  }
  const Triple wind = own_wind.called == nullptr ? vector("wind_m_s") : Triple{}, gust_m_s = vector("gust_m_s");
  PeriodicWind gust;
  gust.mean_m_s = 0;
  gust.amplitude_m_s = std::hypot(gust_m_s[0], gust_m_s[1], gust_m_s[2]);
  gust.period_s = number("gust_period_s", 0.01);
  const bool gusty = gust.amplitude_m_s > 0;
  for (std::size_t i = 0; i < 3 && gusty; ++i) gust.direction[i] = gust_m_s[i] / gust.amplitude_m_s;
  const double turbulence_m_s = number("turbulence_m_s", 0), height_m = number("turbulence_height_m", 0);
  std::uint64_t seed = 1;
  take_whole(given, "turbulence_seed", seed);
  std::string ground_effect;
  take(given, "ground_effect", ground_effect);
  if (std::find(ground_effects.begin(), ground_effects.end(), ground_effect) == ground_effects.end()) {
    refuse_name("ground effect", ground_effect, ground_effects);
  }
  const LinearDamping damping{number("linear_drag_N_s_m", 0), number("rate_damping_N_m_s", 0)};
  Battery battery;
  battery.cells = number("battery_cells", 0);
  battery.capacity_Ah = number("battery_Ah", 0);
  battery.start_charge = number("battery_charge", 0);
  battery.cell_resistance_ohm_Ah = number("battery_resistance_ohm_Ah", 0);
  RotorFault fault;
  take_whole(given, "fault_rotor", fault.rotor);
  fault.share = number("fault_share", 0);
  fault.from_s = number("fault_from_s", 0);
  const Payload payload{number("payload_kg", 0), number("payload_from_s", 0)};
  GroundContact legs;
  legs.leg_length_m = number("leg_length_m", 0);

  FlownEffects effects;
  switch_effect(effects, own_wind, own_wind.called != nullptr);
  switch_effect(effects, own_wrench, own_wrench.called != nullptr);
  switch_effect(effects, StandardAtmosphere{}, is_on("standard_atmosphere"));
  switch_effect(effects, ConstantWind{wind}, wind != Triple{});
  switch_effect(effects, gust, gusty);
  if (turbulence_m_s > 0) {
    std::mt19937_64 engine(seed);
    const double along_m_s = std::hypot(wind[0], wind[1]);
    const std::array<double, 2> direction = {along_m_s > 0 ? wind[0] / along_m_s : 1.0,
                                             along_m_s > 0 ? wind[1] / along_m_s : 0.0};
    switch_effect(effects, DrydenTurbulence<>(engine, DrydenParameters::low_altitude(turbulence_m_s, height_m),
                                              along_m_s, direction));
  }
  switch_effect(effects, battery, battery.cells > 0);
  switch_effect(effects, QuadraticDrag{}, is_on("drag"));
  switch_effect(effects, damping, damping.drag_N_s_m > 0 || damping.rate_damping_N_m_s > 0);
  switch_effect(effects, RotorDrag{}, is_on("rotor_drag"));
  switch_effect(effects, Inflow{}, is_on("inflow"));
  switch_effect(effects, BladeFlapping{}, is_on("flapping"));
  switch_effect(effects, Wake{}, is_on("wake"));
  switch_effect(effects, RotorGroundEffect<CheesemanBennett>{}, ground_effect == "rotors");
  switch_effect(effects, GroundEffect<CheesemanBennett>{}, ground_effect == "cheeseman_bennett");
  switch_effect(effects, GroundEffect<Conyers>{}, ground_effect == "conyers");
  switch_effect(effects, fault, fault.share < 1);
  switch_effect(effects, legs, is_on("ground_contact"));
  switch_effect(effects, payload, payload.mass_kg > 0);
  return effects;
}

FlownQuadrotor vehicle_of(const NamedAirframe& airframe, const FlownEffects& effects) {
  const FlownQuadrotor vehicle = quadrotor_with(effects, airframe.value, paper_site<double>());
  if (vehicle.status() != Status::ok) {
    refuse("airframe " + printable(airframe.name) + " with these effects: " + to_string(vehicle.status()));
  }
  return vehicle;
}

void bind_simulators(py::module_& module) {
  const RecorderErrors no_errors;
  const FlightPlan plan;
  py::class_<PythonSimulator> simulator(
      module, "Simulator",
      "A running simulation: vehicle, pilot, controller, recorder. World NED, body FRD, SI "
      "units. The same seed gives the same bits.");
  simulator
      .def(py::init([](const py::object& airframe, std::uint64_t seed, const py::object& effects,
                       const py::object& pilot, const Triple& start_m, double max_speed_m_s, double gyro_noise_rad_s,
                       double derivative_interval_s, double command_latency_s, double command_jitter_s) {
             const py::object chosen =
                 effects.is_none() ? py::module_::import("pinnquad.effects").attr("Effects")() : effects;
             RecorderErrors errors;
             errors.gyro_noise_rad_s = gyro_noise_rad_s;
             errors.derivative_interval_s = derivative_interval_s;
             errors.command_latency_s = command_latency_s;
             errors.command_jitter_s = command_jitter_s;
             return new PythonSimulator(
                 {airframe_of(airframe), seed, effects_of(chosen), chosen, pilot, start_m, max_speed_m_s, errors});
           }),
           py::arg("airframe") = PaperQuadrotor::name, py::arg("seed").noconvert() = 1, py::kw_only(),
           py::arg("effects") = py::none(), py::arg("pilot") = "random", py::arg("start_m") = triple(plan.start_m),
           py::arg("max_speed_m_s") = PilotStyle{}.max_speed_m_s,
           py::arg("gyro_noise_rad_s") = no_errors.gyro_noise_rad_s,
           py::arg("derivative_interval_s") = no_errors.derivative_interval_s,
           py::arg("command_latency_s") = no_errors.command_latency_s,
           py::arg("command_jitter_s") = no_errors.command_jitter_s,
           "airframe        an Airframe, one of airframe_names(), or a TOML file\n"
           "seed            of the pilot and, apart from it, of the recorder's noise\n"
           "effects         Effects, own ones among them; set_effects() changes them in flight\n"
           "pilot           'random': agile, 10 to 60 m above ground; 'near_ground': 0.1 to 2 m; 'hover'; or a "
           "callable,\n"
           "                asked every 2 ms: pilot(time_s, position_m, velocity_m_s) gives the velocity wanted (NED,\n"
           "                m/s), or (velocity, yaw rate in rad/s): a trajectory of one's own\n"
           "start_m         NED, m; the ground is at z = 0.877 m\n"
           "max_speed_m_s   that the pilot asks for\n"
           "gyro_noise_rad_s, derivative_interval_s, command_latency_s, command_jitter_s\n"
           "                errors of the recording alone (docs/simulator.md)\n\n"
           "It starts in hover; a row is recorded every 0.05 s. ValueError for what makes no sense, pinnquad.Error\n"
           "for an airframe that can't fly, FlightEnded where no hover is possible.")
      .def("fly", &PythonSimulator::fly, py::arg("seconds"),
           "Flies on as the pilot wants, for so many seconds (rounded to ticks of 2 ms). Other threads run meanwhile;\n"
           "Ctrl-C stops it at a tick. FlightEnded at the ground or where a step cannot be calculated. An exception of "
           "a\n"
           "callable of the effects comes through, and leaves the simulator as it was before the call.")
      .def("step", &PythonSimulator::step, py::arg("commands"), py::arg("seconds") = plan.control_period_s(),
           "Flies on with these four motor commands, 0 to 1, instead of the pilot's; else as fly().")
      .def("set_effects", &PythonSimulator::set_effects, py::arg("effects"),
           "From the next tick on the vehicle flies with these Effects.")
      .def_property_readonly("effects", &PythonSimulator::effects, "The present Effects.")
      .def_property_readonly("airframe", &PythonSimulator::airframe, py::return_value_policy::copy,
                             "A copy of the airframe.")
      .def_property_readonly("time_s", &PythonSimulator::time_s, "Seconds flown since the start.")
      .def_property_readonly("flying", &PythonSimulator::flying, "False once the flight has ended.")
      .def_property_readonly("rows", &PythonSimulator::rows, "Rows recorded, those taken left out.")
      .def_property_readonly(
          "state", &PythonSimulator::state,
          "The true state now, a dict: time_s, position_m and velocity_m_s (NED), attitude (w, x, y, z: body to "
          "world),\n"
          "euler_rad (roll, pitch, yaw), body_rates_rad_s, altitude_m above ground, commands (last told to the "
          "motors,\n"
          "not clipped), rotor_commands (behind the rotors' lag), rotor_thrust_N (along body -z), aerodynamic_force_N\n"
          "(body), wind_m_s (NED), air_density_kg_m3, thrust_scale (of a sagging battery),\n"
          "battery_voltage_V, battery_current_A (0 without one), charge_used_C.")
      .def("hover_commands", &PythonSimulator::hover_commands,
           "The four commands of a hover at the present place and time, through all effects; not clipped.")
      .def("recording", &PythonSimulator::recording, "The rows so far, as a Flight of their own.")
      .def("take_recording", &PythonSimulator::take_recording, "The same, and forgets them; the flight goes on.")
      .def(
          "copy", [](const PythonSimulator& self) { return new PythonSimulator(self); },
          "A simulator that flies on from here like this one, and apart from it.")
      .def("__copy__", [](const PythonSimulator& self) { return new PythonSimulator(self); })
      .def("__deepcopy__", [](const PythonSimulator& self, const py::dict&) { return new PythonSimulator(self); })
      .def("__repr__", &PythonSimulator::text);
  pickled(
      simulator, [](const py::object& self) { return self.cast<const PythonSimulator&>().journal(); },
      [](const py::tuple& state) { return PythonSimulator::of_journal(state); });
  module.attr("ground_effects") = py::tuple(py::cast(ground_effects));
}

}  // namespace python
