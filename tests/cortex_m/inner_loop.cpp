// SPDX-License-Identifier: MIT
// The whole inner loop: samples -> accelerations that are wanted (FlightController) -> guarded network with its bias,
// learnt of the flown motion -> desaturated commands. The flight stacks' controller, whose model is a block; or, with
// LIBRARY_LOOP, the library's own parts around an exported header; or, with ONBOARD, the core as it learns its vehicle.
// MODEL_HEADER and MODEL name the model.
#include "inner_loop.hpp"

#include <new>

#include MODEL_HEADER
#ifdef LIBRARY_LOOP
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/inference/guard.hpp"
#else
#include "pinnquad/control/autopilot/neural_controller.hpp"
#endif

namespace {

using pinnquad::Status;
using Vector = pinnquad::Vector3<float>;

Vector vector(const float (&v)[3]) noexcept { return {v[0], v[1], v[2]}; }
pinnquad::Quaternion<float> quaternion(const float (&q)[4]) noexcept { return {q[0], q[1], q[2], q[3]}; }

pinnquad::TrajectoryPoint<float> wanted(const LoopSample& sample) noexcept {
  pinnquad::TrajectoryPoint<float> point;
  point.position_m = vector(sample.wanted_position_m);
  point.velocity_m_s = vector(sample.wanted_velocity_m_s);
  point.acceleration_m_s2 = vector(sample.wanted_acceleration_m_s2);
  return point;
}

#ifdef LIBRARY_LOOP
using Inverse = pinnquad::NetworkInverse<pinnquad::InverseDynamics<MODEL, pinnquad::TrainingGuard>>;
using Adaptive = pinnquad::AdaptiveInverse<float, Inverse>;
using Loop = pinnquad::TrackingController<float, Adaptive>;

Loop made() noexcept {
  const auto airframe = pinnquad::airframe_value<MODEL::Vehicle, float>();
  const Adaptive adaptive(Inverse{{}}, airframe, pinnquad::bias_settings<MODEL>(),
                          pinnquad::FlownMotion<float>(25'000, airframe.rotor_time_constant_s));
  return Loop(airframe, pinnquad::FlightController<float>({}, pinnquad::flight_limits(airframe, 1.0F)), adaptive);
}
#elif defined(ONBOARD)
using Loop = pinnquad::autopilot::NeuralController<MODEL, pinnquad::ModelView<MODEL>,
                                                   pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>, void,
                                                   pinnquad::OnboardInverse<float>>;
constexpr auto learning = pinnquad::autopilot::Learning::excites;
#else
using Loop = pinnquad::autopilot::NeuralController<MODEL>;
constexpr auto learning = pinnquad::autopilot::Learning::off;
#endif

alignas(Loop) unsigned char memory[sizeof(Loop)];
Loop* loop = nullptr;

}  // namespace

#ifdef LIBRARY_LOOP

unsigned char pinnquad_loop_start(const void* /*block*/, std::size_t /*length*/) {
  loop = new (static_cast<void*>(memory)) Loop(made());
  return static_cast<unsigned char>(Status::ok);
}

unsigned char pinnquad_loop_tick(std::uint32_t now_us, const LoopSample* sample, float* commands) {
  const pinnquad::State<float> state{vector(sample->position_m), vector(sample->velocity_m_s),
                                     quaternion(sample->attitude), vector(sample->body_rates_rad_s)};
  pinnquad::Commands<float> answer{};
  const Status status = (*loop)(state, wanted(*sample), std::uint64_t{now_us}, answer);
  for (std::size_t i = 0; i < answer.size(); ++i) commands[i] = answer[i];
  return static_cast<unsigned char>(status);
}

unsigned char pinnquad_loop_bias(float* sums) {
  const pinnquad::detail::MotionBias<float>& bias = loop->feed_forward().bias();
  for (std::size_t k = 0; k < 4; ++k) sums[k] = bias.sums()[k];
  return static_cast<unsigned char>(bias.status());
}

#else

unsigned char pinnquad_loop_start(const void* block, std::size_t length) {
  loop = new (static_cast<void*>(memory)) Loop;
  loop->situation({true, false, learning});
  return static_cast<unsigned char>(loop->offer_model(block, length));
}

unsigned char pinnquad_loop_tick(std::uint32_t now_us, const LoopSample* sample, float* commands) {
  static_cast<void>(loop->body_rates(now_us, vector(sample->body_rates_rad_s)));
  static_cast<void>(loop->attitude(now_us, quaternion(sample->attitude)));
  static_cast<void>(loop->local(now_us, {vector(sample->position_m), vector(sample->velocity_m_s)}));
  static_cast<void>(loop->set_point(now_us, wanted(*sample)));
  pinnquad::Commands<float> answer{};
  pinnquad::autopilot::StepReport report;
  static_cast<void>(loop->step(now_us, answer, report));
  for (std::size_t i = 0; i < answer.size(); ++i) commands[i] = answer[i];
  return static_cast<unsigned char>(report.status);
}

unsigned char pinnquad_loop_bias(float* sums) {
  for (std::size_t k = 0; k < 4; ++k) sums[k] = loop->bias().sums()[k];
  return static_cast<unsigned char>(loop->bias().status());
}

#endif
