// SPDX-License-Identifier: MIT
//
// Everything that may fly, behind C functions named pinnquad_flight_...: the symbol gate looks at what they need.
// Data comes in and goes out through plain arrays, so that nothing can be computed by the compiler instead.
#include <pinnquad/flight.hpp>

#include "../support/hover.hpp"
#include "../support/small_model.hpp"
#include "../support/small_model_variants.hpp"
#include "pinnquad/dynamics/integrator.hpp"
#include "pinnquad/exported/run_time_certificate.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace {

using pinnquad::Commands;
using pinnquad::Quaternion;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::test::SmallModel;

template <class Scalar>
using Everything =
    pinnquad::Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::ConstantWind, pinnquad::PeriodicWind,
                        pinnquad::Battery, pinnquad::QuadraticDrag, pinnquad::RotorDrag, pinnquad::Inflow,
                        pinnquad::BladeFlapping, pinnquad::Wake,
                        pinnquad::RotorGroundEffect<pinnquad::CheesemanBennett>,
                        pinnquad::GroundEffect<pinnquad::Conyers>, pinnquad::GroundEffect<pinnquad::CheesemanBennett>,
                        pinnquad::RotorFault, pinnquad::GroundContact, pinnquad::Payload>;

/// Commands that no rotor can do, but a network may ask for.
struct WideCommands {
  static constexpr double lower = -0.5;
  static constexpr double upper = 1.5;
};

template <class Scalar>
Everything<Scalar> everything() noexcept {
  return Everything<Scalar>(pinnquad::airframe_value<pinnquad::PaperQuadrotor, Scalar>(),
                            pinnquad::paper_site<Scalar>(), {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
}

template <class Scalar>
pinnquad::VehicleState<Scalar> read(const Scalar* v) noexcept {
  pinnquad::VehicleState<Scalar> state;
  state.body.position_m = Vector3<Scalar>(v[0], v[1], v[2]);
  state.body.velocity_m_s = Vector3<Scalar>(v[3], v[4], v[5]);
  state.body.attitude = {v[6], v[7], v[8], v[9]};
  state.body.body_rates_rad_s = Vector3<Scalar>(v[10], v[11], v[12]);
  state.rotors = {v[13], v[14], v[15], v[16]};
  state.time_s = static_cast<double>(v[17]);
  return state;
}

template <class Scalar>
void write(const pinnquad::VehicleState<Scalar>& state, Scalar* v) noexcept {
  for (int i = 0; i < 3; ++i) {
    v[i] = state.body.position_m[i];
    v[3 + i] = state.body.velocity_m_s[i];
    v[10 + i] = state.body.body_rates_rad_s[i];
  }
  const Quaternion<Scalar>& q = state.body.attitude;
  v[6] = q.w, v[7] = q.x, v[8] = q.y, v[9] = q.z;
  for (std::size_t i = 0; i < state.rotors.size(); ++i) v[13 + i] = state.rotors[i];
  v[17] = static_cast<Scalar>(state.time_s);
}

template <class Scalar>
pinnquad::Accelerations<Scalar> motion(const Scalar* v) noexcept {
  pinnquad::Accelerations<Scalar> result;
  result.linear_m_s2 = Vector3<Scalar>(v[0], v[1], v[2]);
  result.angular_rad_s2 = Vector3<Scalar>(v[3], v[4], v[5]);
  return result;
}

template <class Scalar>
unsigned char step(Scalar* state, const Scalar* u, Scalar step_s) noexcept {
  auto vehicle = read(state);
  const Status status = everything<Scalar>().step(vehicle, {u[0], u[1], u[2], u[3]}, step_s);
  write(vehicle, state);
  return static_cast<unsigned char>(status);
}

template <class Scalar>
unsigned char inverse(const Scalar* state, const Scalar* wanted, Scalar* u) noexcept {
  const auto vehicle = read(state);
  Commands<Scalar> commands{};
  const Status status = inverse_commands(everything<Scalar>(), vehicle.body, motion(wanted), wanted[6], commands);
  for (std::size_t i = 0; i < commands.size(); ++i) u[i] = commands[i];
  return static_cast<unsigned char>(status);
}

/// Every policy of a guard that can stand beside the others, falling back to the analytic inverse.
using Guarded = pinnquad::InverseDynamics<
    SmallModel,
    pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::RefuseCommands<WideCommands>, pinnquad::ClipCommands<>,
                     pinnquad::Fallback<pinnquad::AnalyticInverse<Everything<float>>>>>;

Guarded guarded() noexcept { return Guarded(pinnquad::AnalyticInverse<Everything<float>>(everything<float>())); }

/// A unit distribution, and limits of a monitor.
struct Trust {
  static constexpr std::array<float, 16> distribution_mean{};
  static constexpr std::array<float, 136> whitening{1};
  static constexpr double squared_distance_limit = 100;
  static constexpr double command_residual_factor = 0.2, command_residual_limit = 0.05, command_residual_cleared = 0.02;
};
using Trusting =
    pinnquad::InverseDynamics<SmallModel,
                              pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::JointDistance<Trust>,
                                               pinnquad::Fallback<pinnquad::AnalyticInverse<Everything<float>>>>>;

template <class Inverse>
unsigned char predict_and_report(const Inverse& inverse, const float* state, const float* wanted, float* u) noexcept {
  const auto vehicle = read(state);
  Commands<float> commands{};
  typename Inverse::Report report;
  const pinnquad::PlaceAndTime<float> place{vehicle.body.position_m, wanted[6]};
  const Status status = inverse.predict(pinnquad::motion_inputs(vehicle.body, motion(wanted)), place, commands, report);
  for (std::size_t i = 0; i < commands.size(); ++i) u[i] = commands[i];
  u[4] = report.excess[0] + float(report.worst_feature);
  return static_cast<unsigned char>(status);
}

/// A closed loop of everything in control/, the network in it.
template <class Scalar, class Trajectory, class FeedForward>
unsigned char fly(const Trajectory& trajectory, const FeedForward& feed_forward, Scalar* rmse_m) noexcept {
  const auto quadrotor = everything<Scalar>();
  const pinnquad::FlightGains<Scalar> gains{};
  const pinnquad::FlightController<Scalar> controller(
      gains, pinnquad::flight_limits(quadrotor.airframe(), Scalar(1), gains), quadrotor.site().gravity_m_s2);
  const auto result = pinnquad::track(quadrotor, trajectory, controller, feed_forward);
  *rmse_m = result.rmse_m + Scalar(result.fallback.fallbacks());
  return static_cast<unsigned char>(result.status);
}

/// A model of any block, in memory that the caller has.
template <class Scalar>
struct RunTimeAsked {
  pinnquad::RunTimeModel<Scalar> model;
  pinnquad::RunTimeFeatures::Inputs<Scalar> taps[2];
  Scalar x[64], work[256], u[4];
  pinnquad::Certificate certificate;
};
template <class Scalar>
unsigned char predict_at_run_time(const void* block, unsigned long length, RunTimeAsked<Scalar>& asked) {
  auto& model = asked.model;
  Status status = pinnquad::RunTimeModel<Scalar>::open(block, length, model);
  if (status == Status::ok && model.workspace() > 256) status = Status::block_incompatible;
  if (status == Status::ok) status = model.features().check(asked.taps);
  if (status != Status::ok) return static_cast<unsigned char>(status);
  model.features().extract(asked.taps, asked.x);
  model.commands(asked.x, asked.u, asked.work);
  const bool sound = model.golden_difference(asked.work) <= Scalar(pinnquad::golden_tolerance) &&
                     pinnquad::run_time_certificate(model, asked.certificate);
  return static_cast<unsigned char>(sound ? Status::ok : Status::self_test_failed);
}

}  // namespace

extern "C" {

const char* pinnquad_flight_status_text(unsigned char status) {
  return pinnquad::to_string(static_cast<Status>(status));
}

// inference

unsigned char pinnquad_flight_predict(const float* state, const float* wanted, float* u) {
  const auto vehicle = read(state);
  Commands<float> commands{};
  const pinnquad::InverseDynamics<SmallModel> model;
  const Status status = model.predict(pinnquad::motion_inputs(vehicle.body, motion(wanted)), commands);
  for (std::size_t i = 0; i < commands.size(); ++i) u[i] = commands[i];
  return static_cast<unsigned char>(status);
}

unsigned char pinnquad_flight_predict_features(const float* x, float* u) {
  return static_cast<unsigned char>(pinnquad::InverseDynamics<SmallModel>{}.predict_features(x, u));
}

unsigned char pinnquad_flight_predict_guarded(const float* state, const float* wanted, float* u) {
  const auto vehicle = read(state);
  Commands<float> commands{};
  const pinnquad::PlaceAndTime<float> place{vehicle.body.position_m, wanted[6]};
  const Status status = guarded().predict(pinnquad::motion_inputs(vehicle.body, motion(wanted)), place, commands);
  for (std::size_t i = 0; i < commands.size(); ++i) u[i] = commands[i];
  return static_cast<unsigned char>(status);
}

unsigned char pinnquad_flight_predict_reported(const float* state, const float* wanted, float* u) {
  return predict_and_report(guarded(), state, wanted, u);
}

unsigned char pinnquad_flight_predict_monitored(const float* state, const float* wanted, float* u) {
  const auto vehicle = read(state);
  pinnquad::MonitoredInverse<Trusting, Trust> monitored(
      Trusting(pinnquad::AnalyticInverse<Everything<float>>(everything<float>())));
  const Status observed =
      monitored.observe(pinnquad::motion_inputs(vehicle.body, motion(wanted)), {u[0], u[1], u[2], u[3]});
  return observed == Status::ok ? predict_and_report(monitored, state, wanted, u)
                                : static_cast<unsigned char>(observed);
}

unsigned char pinnquad_flight_history(const float* state, const float* wanted, double time_s, float voltage_V,
                                      float* x) {
  using Measured = pinnquad::WithColumns<pinnquad::PaperFeatures, pinnquad::BatteryVoltage>;
  using Past = pinnquad::Windowed<Measured, 3, pinnquad::PeriodMicroseconds<20000>>;
  using History = pinnquad::InputHistory<Past, float>;
  History history;
  const auto vehicle = read(state);
  History::Present present;
  static_cast<pinnquad::MotionInputs<float>&>(present) = pinnquad::motion_inputs(vehicle.body, motion(wanted));
  present.column<pinnquad::BatteryVoltage>() = voltage_V;
  static_cast<void>(history.take(present, time_s - 0.02));
  const Status status = history.take(present, time_s);
  Past::extract(history.inputs(), x);
  return static_cast<unsigned char>(status == Status::ok ? Past::check(history.inputs()) : status);
}

unsigned char pinnquad_flight_parts_of_motion(const float* state, const float* wanted, double time_s, float voltage_V,
                                              float* x) {
  using Measured = pinnquad::WithColumns<pinnquad::PhysicsFeatures, pinnquad::BatteryVoltage>;
  using Past =
      pinnquad::PartlyWindowed<Measured, pinnquad::AccelerationFeatures, 3, pinnquad::PeriodMicroseconds<20000>>;
  pinnquad::InputHistory<Past, float> history;
  pinnquad::InputHistory<Past, float>::Present present;
  static_cast<pinnquad::MotionInputs<float>&>(present) = pinnquad::motion_inputs(read(state).body, motion(wanted));
  present.column<pinnquad::BatteryVoltage>() = voltage_V;
  const Status status = history.take(present, time_s);
  Past::extract(history.inputs(), x);
  return static_cast<unsigned char>(status == Status::ok ? Past::check(history.inputs()) : status);
}

unsigned char pinnquad_flight_self_test() {
  return static_cast<unsigned char>(pinnquad::self_test(pinnquad::InverseDynamics<SmallModel>{}));
}

unsigned char pinnquad_flight_view_predict(const void* block, unsigned long length, const float* x, float* u) {
  using View = pinnquad::ModelView<pinnquad::test::SmallModel>;
  View view;
  const Status status = View::open(block, length, view);
  if (status != Status::ok) return static_cast<unsigned char>(status);
  const pinnquad::InverseDynamics<View> inverse(view);
  if (pinnquad::self_test(inverse) != Status::ok) return static_cast<unsigned char>(Status::self_test_failed);
  return static_cast<unsigned char>(inverse.predict_features(x, u));
}

unsigned char pinnquad_flight_packed_predict(const void* block, unsigned long length, const double* x, double* u) {
  using View = pinnquad::ModelView<pinnquad::test::DoubleModel>;
  static View::Packed packed;
  View view;
  const Status status = View::open(block, length, view, packed);
  if (status != Status::ok) return static_cast<unsigned char>(status);
  const pinnquad::InverseDynamics<View> inverse(view);
  if (pinnquad::self_test(inverse) != Status::ok) return static_cast<unsigned char>(Status::self_test_failed);
  return static_cast<unsigned char>(inverse.predict_features(x, u));
}

unsigned char pinnquad_flight_run_time_predict(const void* block, unsigned long length, RunTimeAsked<float>* asked) {
  return predict_at_run_time(block, length, *asked);
}
unsigned char pinnquad_flight_run_time_predict_in_double(const void* block, unsigned long length,
                                                         RunTimeAsked<double>* asked) {
  return predict_at_run_time(block, length, *asked);
}

unsigned char pinnquad_flight_predict_with_jacobian(const float* x, float* u, float* jacobian) {
  return static_cast<unsigned char>(
      pinnquad::predict_with_jacobian(pinnquad::InverseDynamics<SmallModel>{}, x, u, jacobian));
}

unsigned char pinnquad_flight_predict_batch(const float* x, float* u, unsigned char* statuses, int samples) {
  Status each[64] = {};
  if (samples > 64) return 1;
  pinnquad::predict_batch(pinnquad::InverseDynamics<SmallModel>{}, x, u, each, samples);
  for (int s = 0; s < samples; ++s) statuses[s] = static_cast<unsigned char>(each[s]);
  return 0;
}

float pinnquad_flight_output_schema(float output) {
  constexpr auto airframe = pinnquad::airframe_value<pinnquad::PaperQuadrotor, float>();
  using Schema = pinnquad::RotorSpeedOutputs;
  return Schema::command(output, airframe) + Schema::from_command(output, airframe) +
         Schema::command_slope(output, airframe);
}

// nn: the layers that the small model has not

void pinnquad_flight_tanh_network(const float* parameters, const float* x, float* y) {
  using Net =
      pinnquad::Mlp<float, pinnquad::InputSize<16>, pinnquad::Hidden<2, 12>, pinnquad::OutputSize<4>, pinnquad::Tanh>;
  Net::forward(parameters, x, y);
}

void pinnquad_flight_smooth_network(const float* parameters, const float* x, float* y, float* jacobian) {
  using Net = pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<9>, pinnquad::Gelu, pinnquad::Dense<9>,
                                pinnquad::Silu, pinnquad::Clip, pinnquad::Dense<9>, pinnquad::Softplus,
                                pinnquad::Dense<9>, pinnquad::Sine, pinnquad::Dense<9>, pinnquad::Elu,
                                pinnquad::Dense<9>, pinnquad::LeakyRelu, pinnquad::Dense<4>>;
  pinnquad::JacobianPass<Net>::run(parameters, x, y, jacobian);
  pinnquad::BatchedNetwork<Net>::forward(parameters, x, y, 5);
}

void pinnquad_flight_double_network(const double* parameters, const double* x, double* y) {
  using Net =
      pinnquad::Mlp<double, pinnquad::InputSize<16>, pinnquad::Hidden<1, 8>, pinnquad::OutputSize<4>, pinnquad::Relu>;
  Net::forward(parameters, x, y);
}

// vehicle, dynamics, aero

unsigned char pinnquad_flight_step_float(float* state, const float* u, float step_s) { return step(state, u, step_s); }
unsigned char pinnquad_flight_step_double(double* state, const double* u, double step_s) {
  return step(state, u, step_s);
}
unsigned char pinnquad_flight_inverse_float(const float* state, const float* wanted, float* u) {
  return inverse(state, wanted, u);
}
unsigned char pinnquad_flight_inverse_double(const double* state, const double* wanted, double* u) {
  return inverse(state, wanted, u);
}

unsigned char pinnquad_flight_vehicle_status() { return static_cast<unsigned char>(everything<float>().status()); }

void pinnquad_flight_linearized(const float* wanted, float density_ratio, float* u) {
  const auto airframe = pinnquad::airframe_value<pinnquad::PaperQuadrotor, float>();
  const pinnquad::Rotors<float> rotors(airframe);
  const Commands<float> commands = pinnquad::linearized_commands(airframe, rotors, motion(wanted),
                                                                 pinnquad::standard_gravity_m_s2<float>, density_ratio);
  for (std::size_t i = 0; i < commands.size(); ++i) u[i] = commands[i];
  u[0] += rotors.wrench(commands, density_ratio).force_N[2];
}

void pinnquad_flight_frames(float* v) {
  const auto q = pinnquad::normalized(Quaternion<float>{v[0], v[1], v[2], v[3]});
  const auto euler = pinnquad::to_euler(pinnquad::swap_enu_flu_ned_frd(q));
  const auto back = pinnquad::from_euler(euler);
  const auto moved =
      pinnquad::swap_enu_ned(pinnquad::swap_flu_frd(pinnquad::world_to_body(back, Vector3<float>(v[4], v[5], v[6]))));
  for (int i = 0; i < 3; ++i) v[4 + i] = moved[i];
}

// control

unsigned char pinnquad_flight_track_network(float* rmse_m) {
  const pinnquad::NetworkInverse<Guarded> feed_forward(guarded());
  return fly(pinnquad::FigureEight<float>{}, feed_forward, rmse_m);
}

unsigned char pinnquad_flight_track_analytic(double* rmse_m) {
  return fly(pinnquad::Circle<double>{}, pinnquad::AnalyticInverse<Everything<double>>(everything<double>()), rmse_m);
}

unsigned char pinnquad_flight_track_adaptive(float* rmse_m) {
  using Inverse = pinnquad::NetworkInverse<Guarded>;
  using Reserve = pinnquad::AnalyticInverse<Everything<float>>;
  const pinnquad::AdaptiveInverse<float, Inverse, pinnquad::FlownMotion<float>, Reserve> feed_forward(
      Inverse(guarded()), pinnquad::airframe_value<pinnquad::PaperQuadrotor, float>(),
      pinnquad::bias_settings<SmallModel>(), pinnquad::FlownMotion<float>(25'000, 0.005F, 0.02F),
      Reserve(everything<float>()));
  return fly(pinnquad::FigureEight<float>{}, feed_forward, rmse_m);
}

unsigned char pinnquad_flight_track_incremental(double* rmse_m) {
  using Inverse = pinnquad::AnalyticInverse<Everything<double>>;
  using Incremental = pinnquad::AdaptiveInverse<double, Inverse, pinnquad::FilteredMotion<double>>;
  return fly(pinnquad::Circle<double>{},
             Incremental(Inverse(everything<double>()), pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>()),
             rmse_m);
}

/// Every function of an inverse that learns, tick by tick.
unsigned char pinnquad_flight_learn(const float* state, const float* wanted, float* u) {
  using Inverse = pinnquad::NetworkInverse<Guarded>;
  pinnquad::detail::MotionBias<float> logged(pinnquad::airframe_value<pinnquad::PaperQuadrotor, float>());
  pinnquad::AdaptiveInverse<float, Inverse> inverse(Inverse(guarded()),
                                                    pinnquad::airframe_value<pinnquad::PaperQuadrotor, float>());
  const auto vehicle = read(state);
  Commands<float> commands{u[0], u[1], u[2], u[3]};
  inverse.learn(static_cast<std::uint64_t>(wanted[6]), true, vehicle.body, commands);
  inverse.interrupt();
  logged.resume(inverse.bias().learnt());
  const Status status = inverse(vehicle.body, motion(wanted), 0, commands);
  for (std::size_t i = 0; i < commands.size(); ++i) u[i] = commands[i] + logged.sums()[i];
  inverse.reset();
  return static_cast<unsigned char>(status);
}

unsigned char pinnquad_flight_track_hover(float* rmse_m) {
  pinnquad::Commands<float> trim{};
  const Status status = pinnquad::hover_trim(everything<float>(), Vector3<float>(0.0F, 0.0F, -5.0F), trim);
  if (status != Status::ok) return static_cast<unsigned char>(status);
  const pinnquad::test::Hover<float> still{};
  return fly(still, pinnquad::AnalyticInverse<Everything<float>>(everything<float>()), rmse_m);
}

unsigned char pinnquad_flight_pilot_loop(const float* state, const float* wanted, float* demand) {
  const pinnquad::FlightController<float> controller;
  pinnquad::SetPoint<float> set_point;
  set_point.velocity_m_s = Vector3<float>(wanted[0], wanted[1], wanted[2]);
  set_point.yaw_rate_rad_s = wanted[3];
  pinnquad::Accelerations<float> result;
  const Status status = controller(read(state).body, set_point, result);
  for (int i = 0; i < 3; ++i) {
    demand[i] = result.linear_m_s2[i];
    demand[3 + i] = result.angular_rad_s2[i];
  }
  return static_cast<unsigned char>(status);
}

}  // extern "C"
