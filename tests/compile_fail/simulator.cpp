// SPDX-License-Identifier: MIT
#include "pinnquad/simulation/simulator.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

using namespace pinnquad;

struct Pilot {
  SetPoint<double> operator()(const State<double>&, double) { return {}; }
};
struct Holds {
  void hold(const Commands<double>&, double) {}
};
struct Rows {
  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>&, const VehicleState<double>&, const Commands<double>&) {
    return {};
  }
};
struct Recorder : Holds, Rows {};

template <class Pilot, class Recorder>
void ticked() {
  const Quadrotor<double> quadrotor(airframe_value<PaperQuadrotor, double>());
  Simulator<Quadrotor<double>, Pilot, Recorder>(quadrotor, Pilot{}, {}, Recorder{}).tick();
}

// SOUND
void run() { ticked<Pilot, Recorder>(); }

// CASE NOT_A_PILOT: pinnquad: this type is no pilot
struct Nothing {};
void run() { ticked<Nothing, Recorder>(); }
// CASE RECORDER_WITHOUT_HOLD: pinnquad: this type is no recorder
void run() { ticked<Pilot, Rows>(); }
// CASE RECORDER_WITHOUT_ROWS: pinnquad: this type is no recorder
void run() { ticked<Pilot, Holds>(); }
// CASE EFFECT_NOT_SWITCHED: pinnquad: this effect is none of those that are switched
void run() {
  SwitchedEffects effects;
  switch_effect(effects, RotorGroundEffect<Conyers>{});
}
