// SPDX-License-Identifier: MIT
// The feature sets of models that `train` fits to logged flights (training/log_features.hpp), with the output schemas that
// they have; and those of monotone models on a formula.
#pragma once

#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/rigid_body_inverse.hpp"
#include "pinnquad/outputs/signed_sum_outputs.hpp"
#include "training/log_features.hpp"

namespace programs {

/// As each_schema().
template <class Function>
void each_log_schema(const Function& function) {
  using namespace pinnquad;
  const auto reaches = [&](auto present) {
    using Present = decltype(present);
    function(Present{}, CommandOutputs{});
    function(LogCausalWindow<Present>{}, CommandOutputs{});
    function(LogCentredWindow<Present>{}, CommandOutputs{});
    function(LogCausalWindow<Present>{}, SignedSumOutputs{});
    function(LogCentredWindow<Present>{}, SignedSumOutputs{});
  };
  reaches(PhysicsFeatures{});
  reaches(PhysicsFeaturesWithoutVelocity{});
  reaches(WithColumns<PhysicsFeatures, BatteryVoltage>{});
  reaches(WithColumns<PhysicsFeaturesWithoutVelocity, BatteryVoltage>{});
  function(WithColumns<PaperFeatures, BatteryVoltage>{}, CommandOutputs{});
  function(PaperFeatures{}, ResidualOutputs<LinearizedInverse>{});
  function(PhysicsFeatures{}, SignedSumsOn<RigidBodyInverse>{});
  function(PhysicsFeaturesWithoutVelocity{}, SignedSumOutputs{});  // each_schema() has PhysicsFeatures
  function(WithColumns<PhysicsFeatures, BatteryVoltage>{}, SignedSumOutputs{});
  function(WithColumns<PhysicsFeaturesWithoutVelocity, BatteryVoltage>{}, SignedSumOutputs{});
}

}  // namespace programs
