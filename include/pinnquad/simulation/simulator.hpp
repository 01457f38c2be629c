// SPDX-License-Identifier: MIT
// A running simulation: vehicle, pilot, flight controller, analytic inverse and recorder, one control tick at a time.
// A flight of a known length is fly(), a loop on the simulator.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/simulation/pilot.hpp"
#include "pinnquad/simulation/recorder.hpp"

namespace pinnquad {

/// The clocks, the place, the controller's gains, and how long fly() flies. The default is the paper's data set: 15,000
/// rows at 0.05 s, 750 s.
struct FlightPlan {
  double physics_step_s{0.001};
  int steps_per_control{2};            ///< controller at 500 Hz; the commands are held over these steps
  int controls_per_sample{25};         ///< a row every 0.05 s
  Vector3<double> start_m{0, 0, -35};  ///< NED; the flight starts there in hover
  FlightGains<double> gains{};
  std::size_t samples{15000};  ///< rows that fly() records; a Simulator goes on for as long as it is asked

  double control_period_s() const noexcept { return physics_step_s * steps_per_control; }
  double sample_period_s() const noexcept { return control_period_s() * controls_per_sample; }
};

/// How a flight ended.
enum class FlightEnd {
  completed,   ///< as planned; of a running simulation: it flies
  bad_status,  ///< controller, inverse or physics declined: the Status says why
  ground,      ///< the vehicle's centre came down to the ground; on its legs (aero/ground_contact.hpp) it lands
};

/// Flies `Vehicle` (a Quadrotor<double, Effects...>) as `Pilot` asks and records it by `Recorder`;
/// all are copies, and so is a copy of a simulator, which flies on like its original. A tick: the pilot's
/// set point, the controller's demand, the inverse's commands, desaturated, and physics steps under them. After every
/// `controls_per_sample` ticks a row is recorded, at exact multiples of the sample period. The flight ends by itself
/// when a row finds the vehicle at the ground, or where a Status isn't ok: at the start the airframe's, the hover
/// trim's, a recorder's, `out_of_range` for clocks that do not run; on the way `not_finite`, `no_solution` and
/// `output_not_finite`, also of a row. vehicle() and the recording stay as they were then.
template <class Vehicle, class Pilot, class Recorder = ExactRecorder>
class Simulator {
  static_assert(is_pilot<Pilot>, "pinnquad: this type is no pilot (simulation/pilot.hpp)");
  static_assert(is_recorder<Recorder>,
                "pinnquad: this type is no recorder; it needs hold(commands, time_s) and a call that gives a Sample "
                "(simulation/recorder.hpp)");

 public:
  explicit Simulator(const Vehicle& quadrotor, Pilot pilot, const FlightPlan& settings = {},
                     Recorder recorder = Recorder{})
      : quadrotor_(quadrotor),
        pilot_(std::move(pilot)),
        recorder_(std::move(recorder)),
        settings_(settings),
        step_(quadrotor.time_step(settings.physics_step_s)) {
    vehicle_.body.position_m = settings.start_m;
    begin_recording();
    const bool clocks_run =
        settings.physics_step_s > 0 && settings.steps_per_control > 0 && settings.controls_per_sample > 0;
    Status status = Status::out_of_range;
    if (clocks_run) status = start();
    if (status == Status::ok) status = detail::recorder_status(recorder_);
    if (status != Status::ok) decline(status);
  }

  /// One control tick. True while the vehicle flies on; false, and nothing is done, once the flight has ended.
  bool tick() {
    return tick_with([this] { return ask_pilot(); });
  }

  /// One control tick with these motor commands, not clipped, instead of the pilot's; else as tick(). NaN among them
  /// ends the flight.
  bool tick(const Commands<double>& commands) {
    return tick_with([&] {
      commands_ = commands;
      return Status::ok;
    });
  }

  /// Ticks up to and including the one that records the next row. False: the flight ended before it.
  bool next_row() {
    bool goes_on = tick();
    while (goes_on && !row_is_due()) goes_on = tick();
    return goes_on;
  }

  /// Flies on for a duration, rounded to control ticks; none for a negative one or NaN, until the flight ends for
  /// infinity. True while the vehicle flies.
  bool advance(double duration_s) {
    const double ticks = std::floor(duration_s / settings_.control_period_s() + 0.5);
    for (double done = 0; done < ticks && flying(); ++done) tick();
    return flying();
  }

  bool flying() const noexcept { return end_ == FlightEnd::completed; }
  FlightEnd end() const noexcept { return end_; }
  Status status() const noexcept { return status_; }  ///< not ok where end() is bad_status

  const VehicleState<double>& vehicle() const noexcept { return vehicle_; }
  double time_s() const noexcept { return vehicle_.time_s; }
  double altitude_m() const { return quadrotor_.site().ground_z_m - vehicle_.body.position_m[2]; }  ///< above ground
  /// At the battery's terminals; 0 without one.
  double battery_voltage_V() const noexcept { return quadrotor_.surroundings(vehicle_).battery.voltage_V; }
  /// The last motor commands, not clipped.
  const Commands<double>& commands() const noexcept { return commands_; }
  /// Motor commands for a hover at the present place and time in level attitude, not clipped; through the
  /// vehicle's effects. The inverse's Status (vehicle/inverse.hpp); `commands` is untouched unless it is ok.
  Status hover_commands(Commands<double>& commands) const {
    VehicleState<double> hover = vehicle_;
    hover.body = {};
    hover.body.position_m = vehicle_.body.position_m;
    return inverse_commands(quadrotor_, hover, Accelerations<double>{}, commands);
  }

  const Vehicle& quadrotor() const noexcept { return quadrotor_; }
  const Pilot& pilot() const noexcept { return pilot_; }
  const FlightPlan& settings() const noexcept { return settings_; }

  /// The rows so far, or since the last take_recording().
  const Flight& recording() const noexcept { return recording_; }
  Flight take_recording() {
    Flight taken = std::exchange(recording_, Flight{});
    begin_recording();
    return taken;
  }
  void reserve(std::size_t rows) { recording_.reserve(rows); }

  /// From the next tick on this vehicle flies: another airframe, site or effects, such as those of a SwitchedQuadrotor
  /// (simulation/switched_quadrotor.hpp). State, pilot and clocks go on; so does the controller, which knows the first
  /// vehicle.
  void set_quadrotor(const Vehicle& quadrotor) {
    quadrotor_ = quadrotor;
    step_ = quadrotor.time_step(settings_.physics_step_s);
  }

 private:
  Status start() {
    Commands<double> hover{};
    Status status = quadrotor_.status();
    if (status == Status::ok) status = hover_trim(quadrotor_, settings_.start_m, hover);
    if (status != Status::ok) return status;
    vehicle_.rotors = commands_ = hover;
    const double rotor_scale = quadrotor_.rotor_scale(quadrotor_.surroundings(vehicle_));
    controller_ =
        FlightController<double>(settings_.gains, flight_limits(quadrotor_.airframe(), rotor_scale, settings_.gains),
                                 quadrotor_.site().gravity_m_s2);
    return Status::ok;
  }

  /// `choose()` sets the commands of this tick.
  template <class Choose>
  bool tick_with(const Choose& choose) {
    if (!flying()) return false;
    Status status = choose();
    if (status == Status::ok) status = hold_and_step();
    if (status != Status::ok) {
      decline(status);
      return false;
    }
    ++ticks_;
    if (row_is_due()) record_row();
    return flying();
  }

  Status ask_pilot() {
    Accelerations<double> demand;
    Status status = controller_(vehicle_.body, pilot_(vehicle_.body, vehicle_.time_s), demand);
    if (status == Status::ok) status = inverse_commands(quadrotor_, vehicle_, demand, commands_);
    if (status == Status::ok) commands_ = desaturate(quadrotor_.rotors(), commands_);
    return status;
  }

  Status hold_and_step() {
    recorder_.hold(commands_, vehicle_.time_s);
    Status status = Status::ok;
    for (int i = 0; i < settings_.steps_per_control && status == Status::ok; ++i) {
      status = quadrotor_.step(vehicle_, commands_, step_);
    }
    return status;
  }

  bool row_is_due() const noexcept { return ticks_ % static_cast<std::size_t>(settings_.controls_per_sample) == 0; }

  void record_row() {
    const std::size_t row = ticks_ / static_cast<std::size_t>(settings_.controls_per_sample);
    vehicle_.time_s = static_cast<double>(row) * settings_.sample_period_s();  // sums of steps drift, products do not
    if (altitude_m() <= 0) {
      end_ = FlightEnd::ground;
      return;
    }
    const Sample sample = recorder_(quadrotor_, vehicle_, commands_);
    if constexpr (detail::has_columns<Recorder>) recorder_.measure(quadrotor_, vehicle_, extra_.data());
    if (has_battery_) extra_.back() = battery_voltage_V();
    if (!all_finite(to_values(sample)) || !all_finite(extra_)) {
      decline(Status::output_not_finite);
      return;
    }
    recording_.push_back(sample, extra_.data(), extra_.size());
  }

  void begin_recording() {
    if constexpr (detail::has_columns<Recorder>) {
      for (const ColumnName& column : recorder_.columns()) recording_.add_column({column, {}});
    }
    has_battery_ = battery_voltage_V() > 0;
    if (has_battery_) recording_.add_column({{BatteryVoltage::name, BatteryVoltage::unit}, {}});
    extra_.resize(recording_.columns().size());
  }

  void decline(Status status) noexcept {
    end_ = FlightEnd::bad_status;
    status_ = status;
  }

  Vehicle quadrotor_;
  Pilot pilot_;
  Recorder recorder_;
  FlightPlan settings_;
  typename Vehicle::TimeStep step_;
  FlightController<double> controller_;
  VehicleState<double> vehicle_{};
  Commands<double> commands_{};
  std::size_t ticks_{0};
  Flight recording_;
  bool has_battery_ = false;   ///< when the recording began
  std::vector<double> extra_;  ///< of a row, before it is recorded
  FlightEnd end_{FlightEnd::completed};
  Status status_{Status::ok};
};

/// A flight in figures. Ranges are those of the true motion at the recorded rows.
struct FlightReport {
  FlightEnd end{FlightEnd::completed};
  Status status{Status::ok};
  VehicleState<double> last{};  ///< where and when it ended
  std::size_t rows{0};
  double max_speed_m_s{0};
  double min_altitude_m{0};  ///< above ground
  double max_altitude_m{0};
  double max_tilt_rad{0};
  double saturated_share{0};  ///< rows in which a rotor is at 0 or at 1
};

/// A flight and what is worth knowing of it.
struct RecordedFlight {
  Flight flight;
  FlightReport report;
};

/// Angle between the body's down axis and the world's, 0..pi.
inline double tilt_rad(const Quaternion<double>& attitude) noexcept {
  const double upright = body_down_axis(attitude)[2];
  return std::acos(upright < -1 ? -1 : upright);  // upside down, rounding goes beyond
}

/// Flies and records. `observer(const Simulator<Vehicle, Pilot, Recorder>&)` is called after each row: it sees the true
/// state, and the row as the last of the recording. A Status that isn't ok, or the ground, ends the flight; the rows up
/// to there are kept and the report says where.
template <class Vehicle, class Pilot, class Observer, class Recorder = ExactRecorder,
          class = std::enable_if_t<!is_recorder<Observer>>>
RecordedFlight fly(const Vehicle& quadrotor, const Pilot& pilot, const FlightPlan& plan, Observer observer,
                   const Recorder& recorder = Recorder{}) {
  Simulator<Vehicle, Pilot, Recorder> simulator(quadrotor, pilot, plan, recorder);
  simulator.reserve(plan.samples);
  RecordedFlight recorded;
  FlightReport& report = recorded.report;
  std::size_t saturated_rows = 0;
  while (report.rows < plan.samples && simulator.next_row()) {
    const State<double>& body = simulator.vehicle().body;
    const double speed_m_s = body.velocity_m_s.norm();
    const double tilt = tilt_rad(body.attitude);
    const double altitude_m = simulator.altitude_m();
    if (speed_m_s > report.max_speed_m_s) report.max_speed_m_s = speed_m_s;
    if (tilt > report.max_tilt_rad) report.max_tilt_rad = tilt;
    if (report.rows == 0 || altitude_m < report.min_altitude_m) report.min_altitude_m = altitude_m;
    if (report.rows == 0 || altitude_m > report.max_altitude_m) report.max_altitude_m = altitude_m;
    if (saturated(simulator.commands())) ++saturated_rows;
    ++report.rows;
    observer(std::as_const(simulator));
  }
  report.end = simulator.end();
  report.status = simulator.status();
  report.last = simulator.vehicle();
  if (report.rows > 0) report.saturated_share = static_cast<double>(saturated_rows) / static_cast<double>(report.rows);
  recorded.flight = simulator.take_recording();
  return recorded;
}

/// The same, with nobody who watches.
template <class Vehicle, class Pilot, class Recorder = ExactRecorder, class = std::enable_if_t<is_recorder<Recorder>>>
RecordedFlight fly(const Vehicle& quadrotor, const Pilot& pilot, const FlightPlan& plan = {},
                   const Recorder& recorder = Recorder{}) {
  return fly(
      quadrotor, pilot, plan, [](const auto&) {}, recorder);
}

}  // namespace pinnquad
