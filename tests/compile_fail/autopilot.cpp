// SPDX-License-Identifier: MIT
// CASE COLUMN_OF_NO_STACK: pinnquad: this model asks for a column that no flight stack gives the controller
// CASE CENTRED_WINDOW: pinnquad: a centred window looks ahead, and no loop can
// CASE ALTITUDE: this controller is given no altitude above ground
// CASE PAST_WITH_LIMITS_OF_TRUST: pinnquad: limits of trust are those of a model of the present motion alone
#include "../flight_stacks/past_model.hpp"
#include "../flight_stacks/structured_trust.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace {

using namespace pinnquad;

struct PackTemperature {
  static constexpr const char* name = "pack_temperature";
  static constexpr const char* unit = "degC";
};

#if defined(COLUMN_OF_NO_STACK)
using Present = WithColumns<AccelerationFeatures, BatteryVoltage, PackTemperature>;
#elif defined(ALTITUDE)
using Present = WithColumns<PaperFeaturesWithAltitude, BatteryVoltage>;
#else
using Present = WithColumns<AccelerationFeatures, BatteryVoltage>;
#endif

#if defined(CENTRED_WINDOW)
using Features = Windowed<Present, 3, PeriodMicroseconds<20000>, Centred>;
#else
using Features = Windowed<Present, 3, PeriodMicroseconds<20000>>;
#endif

#if defined(PAST_WITH_LIMITS_OF_TRUST)
using Trust = StructuredQuadModelTrust;
#else
using Trust = void;
#endif

using Model = autopilot::test::PastModel;
using Controller = autopilot::NeuralController<Model, ModelView<Model>, Quadrotor<float, QuadraticDrag>, Trust>;

}  // namespace

int main() {
  autopilot::detail::ModelInputs<Features> inputs;
  const Controller controller;
  return inputs.take({}).complete || controller.ready() ? 1 : 0;
}
