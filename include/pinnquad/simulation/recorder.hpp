// SPDX-License-Identifier: MIT
// A recorder is a policy: what a flight log says of the motion of one instant and of the commands behind it.
// Contract, called in time order:
//   void hold(const Commands<double>& commands, double time_s);
//     at each control tick: from this instant on these commands, not clipped, go out to the motors;
//   template <class... Effects> Sample operator()(const Quadrotor<double, Effects...>&, const VehicleState<double>&,
//                                                 const Commands<double>& commands);
//     the row of the present instant; `commands` are those held up to it.
// Optional: `Status status() const noexcept`, asked before the flight: whether its settings make sense;
//   std::vector<ColumnName> columns() const, and for each row, behind it, a value per column:
//   template <class... Effects> void measure(const Quadrotor<double, Effects...>&, const VehicleState<double>&, double* values).
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

namespace detail {
template <class Recorder, class = void>
struct Holds : std::false_type {};
template <class Recorder>
struct Holds<Recorder,
             std::void_t<decltype(std::declval<Recorder&>().hold(std::declval<const Commands<double>&>(), 0.0))>>
    : std::true_type {};
template <class Recorder, class = void>
struct MakesRows : std::false_type {};
template <class Recorder>
struct MakesRows<Recorder, std::void_t<decltype(std::declval<Recorder&>()(std::declval<const Quadrotor<double>&>(),
                                                                          std::declval<const VehicleState<double>&>(),
                                                                          std::declval<const Commands<double>&>()))>>
    : std::is_same<Sample, decltype(std::declval<Recorder&>()(std::declval<const Quadrotor<double>&>(),
                                                              std::declval<const VehicleState<double>&>(),
                                                              std::declval<const Commands<double>&>()))> {};
/// A recorder whose settings can be wrong has `Status status() const noexcept`; ok for one that has none.
template <class Recorder, class = void>
struct RecorderStatus {
  static Status of(const Recorder&) noexcept { return Status::ok; }
};
template <class Recorder>
struct RecorderStatus<Recorder, std::void_t<decltype(std::declval<const Recorder&>().status())>> {
  static Status of(const Recorder& recorder) noexcept { return recorder.status(); }
};
/// A recorder of motion alone has no extra columns.
template <class Recorder, class = void>
struct RecorderColumns {
  static constexpr bool has_columns = false;
  static std::vector<ColumnName> of(const Recorder&) { return {}; }
  template <class Quadrotor>
  static void measure(Recorder&, const Quadrotor&, const VehicleState<double>&, double*) {}
};
template <class Recorder>
struct RecorderColumns<Recorder, std::void_t<decltype(std::declval<const Recorder&>().columns())>> {
  static constexpr bool has_columns = true;
  static std::vector<ColumnName> of(const Recorder& recorder) { return recorder.columns(); }
  template <class Quadrotor>
  static void measure(Recorder& recorder, const Quadrotor& quadrotor, const VehicleState<double>& vehicle,
                      double* values) {
    recorder.measure(quadrotor, vehicle, values);
  }
};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class Recorder>
inline constexpr bool is_recorder = detail::Holds<Recorder>::value&& detail::MakesRows<Recorder>::value;

/// The vehicle's row at its present time, without error. Accelerations come from the dynamics (docs/paper.md, deviation
/// 14) with the rotors as they turn now, behind their lag, not from differences. Commands are what was held up to this
/// instant, clipped as the rotors clip it: the command, not the lag-filtered thrust, because that is what a flight log
/// has and what the paper's network is to give. Behind a 5 ms lag the rotors differ from it by about 5 ms times its
/// rate of change, some 1e-2 in agile flight: motion and command determine each other that well and no better. Altitude
/// is above ground.
struct ExactRecorder {
  void hold(const Commands<double>& /*commands*/, double /*time_s*/) const noexcept {}

  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& vehicle,
                    const Commands<double>& commands) const noexcept {
    const State<double>& body = vehicle.body;
    const Accelerations<double> motion = quadrotor.evaluate(body, vehicle.rotors, vehicle.time_s).motion;
    const EulerAngles<double> euler = to_euler(body.attitude);
    Sample sample;
    sample.time_s = vehicle.time_s;
    sample.linear_acceleration_m_s2 = motion.linear_m_s2;
    sample.angular_acceleration_rad_s2 = motion.angular_rad_s2;
    sample.velocity_m_s = body_velocity(body);
    sample.body_rates_rad_s = body.body_rates_rad_s;
    sample.roll_rad = euler.roll_rad;
    sample.pitch_rad = euler.pitch_rad;
    sample.yaw_rad = euler.yaw_rad;
    sample.altitude_m = quadrotor.site().ground_z_m - body.position_m[2];
    for (std::size_t i = 0; i < commands.size(); ++i) sample.commands[i] = clip_command(commands[i]);
    return sample;
  }
};

/// Another recorder's rows, and extra columns beside them. A Column is what features/extra_columns.hpp says, with a
/// `double operator()(const Quadrotor&, const VehicleState<double>&)`: what its sensor shows at the present instant.
template <class Recorder, class... Column>
class ColumnRecorder {
  static_assert(!detail::RecorderColumns<Recorder>::has_columns,
                "pinnquad: this recorder has columns of its own already: name all in one ColumnRecorder");

 public:
  explicit ColumnRecorder(Recorder recorder = Recorder{}, Column... column)
      : recorder_(std::move(recorder)), columns_(std::move(column)...) {}

  void hold(const Commands<double>& commands, double time_s) { recorder_.hold(commands, time_s); }
  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& vehicle,
                    const Commands<double>& commands) {
    return recorder_(quadrotor, vehicle, commands);
  }
  Status status() const noexcept { return detail::RecorderStatus<Recorder>::of(recorder_); }

  std::vector<ColumnName> columns() const { return {ColumnName{Column::name, Column::unit}...}; }
  template <class... Effects>
  void measure(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& vehicle, double* values) {
    std::apply([&](auto&... column) { ((*values++ = column(quadrotor, vehicle)), ...); }, columns_);
  }

 private:
  Recorder recorder_;
  std::tuple<Column...> columns_;
};

}  // namespace pinnquad
