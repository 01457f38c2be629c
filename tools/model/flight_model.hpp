// SPDX-License-Identifier: MIT
// A model that is ready to run over flights, whichever it is.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "model/replayed_row.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// `flight_stack`: as control/autopilot: absurd commands are refused too, and the analytic inverse answers where the
/// network declines. `training`: TrainingGuard alone, as an InverseDynamics that names no guard.
enum class ReplayGuard { flight_stack, training };

class FlightModel {
 public:
  FlightModel() = default;
  FlightModel(const FlightModel&) = delete;
  FlightModel& operator=(const FlightModel&) = delete;
  virtual ~FlightModel() = default;

  /// Adds a row per row of the flight, the one of that number; calls `on_row()` after each. Throws
  /// std::invalid_argument for a flight without a column that the model asks for.
  virtual void run(const pinnquad::Flight& flight, std::size_t number, std::vector<ReplayedRow>& rows,
                   const std::function<void()>& on_row) const = 0;
};

/// Of a model, which must stay where it is.
std::unique_ptr<const FlightModel> flight_model(const pinnquad::BlockModel& model, ReplayGuard guard);

}  // namespace programs
