// SPDX-License-Identifier: MIT
// Evidence for the verdict on a model: by its block, by flights that judge it, by what is found of its signs
// (training/model_verdict.hpp).
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/held_columns.hpp"
#include "flight/block_loop.hpp"
#include "model/evaluation.hpp"
#include "model/findings.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "training/model_verdict.hpp"

namespace programs {

/// A figure-eight that the model flies in the simulator, its columns held at these values, or at the middle of their
/// training ranges.
inline nlohmann::json eight_of(const pinnquad::BlockModel& model, std::optional<std::vector<double>> columns = {},
                               const std::optional<pinnquad::Battery>& battery = {}) {
  if (model.features().window().latest_s > 0) return {};
  try {
    const std::string eight = loop_trajectories.front();
    if (!columns) columns = held_columns(range_of(model).columns(), {});
    return flight_evidence(fly_loop(model, {eight, model.airframe(), true, *columns, battery}), eight);
  } catch (const std::invalid_argument& refused) {
    return {{"why_not", refused.what()}};
  }
}

/// The figures that the block records, the proof of its signs, and how it flies eight_of(); `flies`: false where the
/// caller has a flight of its own.
inline ModelEvidence evidence_of(const pinnquad::BlockModel& model, bool flies = true) {
  ModelEvidence evidence{model.name(), {}, flies ? eight_of(model) : nlohmann::json()};
  evidence.block = pinnquad::printable(model.path());
  const std::string airframe = model.airframe_name(), assumed = "assumed";
  evidence.known = airframe.size() <= assumed.size() ||
                   airframe.compare(airframe.size() - assumed.size(), assumed.size(), assumed) != 0;
  double r2 = 0;
  if (pinnquad::parse_number(model.provenance("test_r_squared"), r2)) evidence.held_out.emplace().test_r_squared = r2;
  if (model.angular_accelerations().empty()) {
    evidence.signs = Signs::not_asked;
  } else if (const auto proof = model.proven_signs()) {
    if (evidence.known) evidence.slopes = odd_slopes(*proof, model.airframe());
  } else {
    evidence.signs = Signs::unknown;
  }
  return evidence;
}

/// With the R^2 of these flights, where it is worse than the one that the block records.
inline ModelEvidence evidence_of(const pinnquad::BlockModel& model, const EvaluatedModel& evaluation) {
  ModelEvidence evidence = evidence_of(model);
  const double r_squared = evaluation.judged.errors.mean.r_squared;
  if (!evidence.held_out || !(r_squared >= evidence.held_out->test_r_squared)) {
    evidence.held_out = pinnquad::Verdict{r_squared};
    evidence.rows = "these flights";
  }
  return evidence;
}

/// With a counterexample to its signs, or without one.
inline ModelEvidence evidence_of(const pinnquad::BlockModel& model, const Findings& findings) {
  ModelEvidence evidence = evidence_of(model);
  if (findings.proven()) return evidence;
  evidence.signs = findings.search.found ? Signs::refuted : Signs::unrefuted;
  if (findings.search.found) evidence.refuted_about = axis_names[findings.search.found->asked.axis];
  return evidence;
}

}  // namespace programs
