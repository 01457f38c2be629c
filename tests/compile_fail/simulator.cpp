// SPDX-License-Identifier: MIT
// CASE NOT_A_PILOT: pinnquad: this type is no pilot
// CASE RECORDER_WITHOUT_HOLD: pinnquad: this type is no recorder
// CASE RECORDER_WITHOUT_ROWS: pinnquad: this type is no recorder
// CASE GROUND_EFFECT_BY_TYPE: pinnquad: this vehicle.s effects are its type
#include "pinnquad/simulation/simulator.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/switchable_quadrotor.hpp"

namespace {

struct Pilot {
#if !defined(NOT_A_PILOT)
  pinnquad::SetPoint<double> operator()(const pinnquad::State<double>&, double) { return {}; }
#endif
};

struct Recorder {
#if !defined(RECORDER_WITHOUT_HOLD)
  void hold(const pinnquad::Commands<double>&, double) {}
#endif
#if !defined(RECORDER_WITHOUT_ROWS)
  template <class... Effects>
  pinnquad::Sample operator()(const pinnquad::Quadrotor<double, Effects...>&, const pinnquad::VehicleState<double>&,
                              const pinnquad::Commands<double>&) {
    return {};
  }
#endif
};

#if defined(GROUND_EFFECT_BY_TYPE)
using Vehicle = pinnquad::Quadrotor<double, pinnquad::ConyersGroundEffect>;
#else
using Vehicle = pinnquad::SwitchableQuadrotor<>;
#endif

}  // namespace

int main() {
  const Vehicle quadrotor(pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>());
  pinnquad::Simulator<Vehicle, Pilot, Recorder> simulator(quadrotor, Pilot{}, {}, Recorder{});
  simulator.set_ground_effect(pinnquad::GroundEffectModel::conyers);
  return simulator.tick() ? 0 : 1;
}
