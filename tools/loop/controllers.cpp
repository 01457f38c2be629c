// SPDX-License-Identifier: MIT
#include "loop/controllers.hpp"

#include <stdexcept>

#include "loop/policy_parts.hpp"
#include "pinnquad/control/integral_inverse.hpp"

namespace programs {

using namespace pinnquad;

FlightGains<double> flight_gains(const LoopGains& factors) {
  FlightGains<double> gains;
  gains.position_1_s *= factors.outer;
  gains.velocity_1_s *= factors.outer;
  for (double* gain : {&gains.tilt_1_s, &gains.yaw_1_s, &gains.roll_pitch_rate_1_s, &gains.yaw_rate_1_s}) {
    *gain *= factors.inner;
  }
  return gains;
}

AnyPolicy loop_policy(const std::string& name, const LoopKnowledge& known, const LoopGains& gains) {
  const PolicyParts parts(known, gains);
  if (name == "pid") return AnyPolicy(IntegralInverse<double, PolicyParts::Formula>(parts.rigid_body, gains.learning));
  if (name == "formula") return AnyPolicy(parts.formula);
  if (name == "formula_adaptive") return AnyPolicy(parts.adaptive(parts.formula));
  if (name == "indi") return AnyPolicy(parts.incremental(parts.at_once, parts.rigid_body));
  if (name == "structured") return AnyPolicy(parts.of_model(parts.falls_back()));
  const AnyFeedForward network = parts.of_model(TrainingGuard{});
  if (name == "structured_indi") return AnyPolicy(parts.incremental(parts.at_once, network, parts.formula));
  if (name == "adaptive") return AnyPolicy(parts.adaptive(network, parts.formula));
  throw std::out_of_range(name);
}

}  // namespace programs
