// SPDX-License-Identifier: MIT
// Conditions that the models of the command `beyond` are trained and judged on: a condition is a flight or two, rows
// that train, validate and test, and the airframe that a model is told.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/data/split.hpp"
#include "pinnquad/loss/context.hpp"
#include "study/flights.hpp"

namespace study {

/// Does an airframe that is told wrong make a difference to a condition's models?
enum class Told { the_truth, something_wrong };

struct Condition {
  std::string name;     ///< in rows.csv, the flight's column
  std::string summary;  ///< for the page
  Told told = Told::the_truth;
  pinnquad::GivenAirframe airframe;  ///< that models are told and judged by
  std::vector<std::string> flights;  ///< names for fly_for_beyond()
  /// Rows of these flights, in the order of `flights`; views of them.
  std::function<pinnquad::RowSplit(const std::vector<const pinnquad::Flight*>&)> split;
  /// The flight of the closed loop; none: no flight.
  std::optional<pinnquad::Airframe<double>> in_loop{};
};

/// The conditions that are flown here, all of them.
std::vector<Condition> flown_conditions();

/// Of a recorded flight, 60 / 20 / 20. `airframe`: what flew it.
Condition given_condition(const std::string& name, const pinnquad::GivenAirframe& airframe);

/// Those of `all` that are named, each once, in their order; all for no names. Throws std::invalid_argument, one line.
std::vector<Condition> chosen_conditions(const std::vector<Condition>& all, const std::vector<std::string>& names);

/// Flies "d1", "d2", "d3"; with "_noisy" behind it as a log has it (noisy_gyro_errors()), with "_payload" a fifth
/// heavier. Throws std::invalid_argument, one line, if the flight ends early.
pinnquad::Flight fly_for_beyond(const programs::StudyFlight& id);

/// The border of speed extrapolation, over ground.
inline constexpr double slow_m_s = 5;

/// Rows of `range` that `takes(sample)`, in pieces of two rows or more.
pinnquad::RowSet rows_where(const pinnquad::Flight& flight, const pinnquad::IndexRange& range,
                            const std::function<bool(const pinnquad::Sample&)>& takes);

}  // namespace study
