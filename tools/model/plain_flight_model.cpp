// SPDX-License-Identifier: MIT
// Models that a row of a flight is enough for.
#include "model/replay_flight.hpp"

namespace programs {

std::unique_ptr<const FlightModel> flight_model(const Block& block, const Identity& identity, ReplayGuard guard) {
  std::unique_ptr<const FlightModel> model = detail::plain_flight_model(block, identity, guard);
  return model ? std::move(model) : detail::physics_flight_model(block, identity, guard);
}

std::unique_ptr<const FlightModel> detail::plain_flight_model(const Block& block, const Identity& identity,
                                                              ReplayGuard guard) {
  std::unique_ptr<const FlightModel> model;
  each_schema([&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    if (shape_hash_of<Features, Outputs>(identity.answer, identity.airframe) != block.shape_hash) return;
    model = block.is_double ? flight_model_of<Features, Outputs, double>(block, identity, guard)
                            : flight_model_of<Features, Outputs, float>(block, identity, guard);
  });
  return model;
}

}  // namespace programs
