// SPDX-License-Identifier: MIT
#include "../flight_stacks/past_model.hpp"
#include "../flight_stacks/structured_trust.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

using namespace pinnquad;

template <class Present, class... At>
bool takes() {
  autopilot::detail::ModelInputs<Windowed<Present, 3, PeriodMicroseconds<20000>, At...>> inputs;
  return inputs.take({}).complete;
}
template <class Trust>
bool controls() {
  using Model = autopilot::test::PastModel;
  const autopilot::NeuralController<Model, ModelView<Model>, Quadrotor<float, QuadraticDrag>, Trust> controller;
  return controller.ready();
}

// SOUND
const bool taken = takes<WithColumns<AccelerationFeatures, BatteryVoltage>>(), ready = controls<void>();

// CASE COLUMN_OF_NO_STACK: pinnquad: this model asks for a column that no flight stack gives the controller
struct PackTemperature {
  static constexpr const char* name = "pack_temperature";
  static constexpr const char* unit = "degC";
};
const bool taken = takes<WithColumns<AccelerationFeatures, BatteryVoltage, PackTemperature>>();
// CASE CENTRED_WINDOW: pinnquad: a centred window looks ahead, and no loop can
const bool taken = takes<WithColumns<AccelerationFeatures, BatteryVoltage>, Centred>();
// CASE ALTITUDE: this controller is given no altitude above ground
const bool taken = takes<WithColumns<PaperFeaturesWithAltitude, BatteryVoltage>>();
// CASE PAST_WITH_LIMITS_OF_TRUST: pinnquad: limits of trust are those of a model of the present motion alone
const bool ready = controls<StructuredQuadModelTrust>();
