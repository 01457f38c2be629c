// SPDX-License-Identifier: MIT
// The feature sets of models that `train` fits to logged flights (training/log_features.hpp), with the output schemas
// that they have; and those of monotone models on a base.
#pragma once

#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
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
    function(LogCausalWindow<Present>{}, AxisCommandOutputs{});
    function(LogCentredWindow<Present>{}, AxisCommandOutputs{});
  };
  reaches(PhysicsFeatures{});
  reaches(PhysicsFeaturesWithoutVelocity{});
  reaches(WithColumns<PhysicsFeatures, BatteryVoltage>{});
  reaches(WithColumns<PhysicsFeaturesWithoutVelocity, BatteryVoltage>{});
  function(WithColumns<PaperFeatures, BatteryVoltage>{}, CommandOutputs{});
  function(PaperFeatures{}, ResidualOutputs<LinearizedBase>{});
  function(PhysicsFeatures{}, SignedSumsOn<RigidBodyBase>{});
  function(PhysicsFeaturesWithoutVelocity{}, AxisCommandOutputs{});  // each_schema() has PhysicsFeatures
  function(WithColumns<PhysicsFeatures, BatteryVoltage>{}, AxisCommandOutputs{});
  function(WithColumns<PhysicsFeaturesWithoutVelocity, BatteryVoltage>{}, AxisCommandOutputs{});
}

}  // namespace programs
