// SPDX-License-Identifier: MIT
// Models that `train` fits to logged flights: physics as features, battery voltage, windows.
#include "model/log_schemas.hpp"
#include "model/replay_flight.hpp"

namespace programs {

std::unique_ptr<const FlightModel> detail::physics_flight_model(const Block& block, const Identity& identity,
                                                                ReplayGuard guard) {
  std::unique_ptr<const FlightModel> model;
  each_log_schema([&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    if (block.is_double || shape_hash_of<Features, Outputs>(identity.answer, identity.airframe) != block.shape_hash) {
      return;
    }
    model = flight_model_of<Features, Outputs, float>(block, identity, guard);
  });
  return model;
}

}  // namespace programs
