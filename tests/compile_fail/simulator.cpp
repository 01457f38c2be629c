// SPDX-License-Identifier: MIT
// CASE NOT_A_PILOT: pinnquad: this type is no pilot
// CASE RECORDER_WITHOUT_HOLD: pinnquad: this type is no recorder
// CASE RECORDER_WITHOUT_ROWS: pinnquad: this type is no recorder
// CASE EFFECT_NOT_SWITCHED: pinnquad: this effect is none of those that are switched
#include "pinnquad/simulation/simulator.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

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

using Vehicle = pinnquad::Quadrotor<double>;

}  // namespace

int main() {
  const Vehicle quadrotor(pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>());
  pinnquad::Simulator<Vehicle, Pilot, Recorder> simulator(quadrotor, Pilot{}, {}, Recorder{});
#if defined(EFFECT_NOT_SWITCHED)
  pinnquad::SwitchedEffects effects;
  pinnquad::switch_effect(effects, pinnquad::RotorGroundEffect<pinnquad::Conyers>{});
#endif
  return simulator.tick() ? 0 : 1;
}
