// SPDX-License-Identifier: MIT
// A vehicle whose thrust sags with its battery, and the feature sets that know of it: shared by what trains and what
// flies.
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace battery {

using namespace pinnquad;

/// A pack that loses its voltage evenly. A rotor's greatest thrust goes with its square.
struct Pack {
  static constexpr double full_V = 16.8;
  double start_V = full_V;
  double drop_V_s = 0.013;

  double voltage_V(double time_s) const noexcept { return start_V - drop_V_s * time_s; }

  template <class Scalar>
  void surroundings(Surroundings<Scalar>& air) const noexcept {
    const Scalar share = Scalar(voltage_V(double(air.time_s)) / full_V);
    air.thrust_scale *= share * share;
  }
};

using Vehicle = Quadrotor<double, Pack>;

inline Vehicle vehicle(double start_V) {
  return Vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), Pack{start_V});
}

using Voltage = WithColumns<PaperFeatures, BatteryVoltage>;
using Past = Windowed<Voltage, 2, PeriodMicroseconds<50000>>;

}  // namespace battery
