// SPDX-License-Identifier: MIT
// The proof of a model's signs, or the search for what refutes it (docs/certificate.md).
#include "model/findings.hpp"

#include <cmath>

#include "model/searched_model.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "training/certificate_words.hpp"
#include "training/model_figures.hpp"

namespace programs {

using namespace pinnquad;

const char* in_words(const BlockModel::ProvenSigns& proof) {
  if (!proof.structure) return "the model is affine: its derivatives are the same everywhere";
  return "structure: an affine base in which each signed sum sees the angular acceleration about its own axis alone, "
         "with a slope above 0, and a residual that sees none";
}

bool has_base(const BlockModel& model) {
  return model.with([](const auto& own) { return own.records().base.count != 0; });
}

/// To what moves several features at once. The body rates move a base too, which is no part of the response.
static void add_responses(const BlockModel& model, Findings& findings) {
  const auto along = [&](const std::optional<Direction>& direction) {
    if (!direction) return std::optional<Response>();
    return model.with([&](const auto& own) {
      return std::optional(response_along(*direction, own.network(), own.parameters(), own.scales().input_deviation,
                                          own.scales().output_deviation));
    });
  };
  findings.thrust = along(more_thrust(findings.names));
  const RunTimeFeatures::Window& window = model.features().window();
  if (has_base(model) || window.taps < 2) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    findings.with_rates[axis] = along(held_with_rates(findings.names, axis, {window.period_s, window.earliest_s},
                                                      model.envelope_lower(), model.envelope_upper()));
  }
}

static std::vector<std::string> uncounted_features(const BlockModel& model) {
  std::vector<std::string> names;
  const RunTimeNetwork::Part& base = model.network().part(0);
  if (!model.is_axis_commands() || !base.axis_aligned) return names;
  model.with([&](const auto& own) {
    for (int i = 0; i < own.features().size(); ++i) {
      const ShownAcceleration shown = shown_acceleration(own, i);
      bool counted = shown == ShownAcceleration::none;
      for (int tap = 0; tap < base.three_count; ++tap) {
        counted = counted || (shown != ShownAcceleration::unknown && i - base.threes[tap] == static_cast<int>(shown));
      }
      if (!counted) names.emplace_back(own.features()[i].name);
    }
  });
  return names;
}

Findings findings_of(const BlockModel& model, double seconds, std::uint64_t seed) {
  Findings findings;
  findings.names = model.feature_names();
  bool is_asked = false;
  for (const BlockModel::AccelerationPlace& place : model.angular_accelerations()) {
    (place.is_present ? is_asked : findings.past_or_future) = true;
  }
  if (!is_asked) {
    throw InputError(model.path(), 0, 0, "a model that is asked for an angular acceleration", "one that is not");
  }
  findings.uncounted = uncounted_features(model);
  findings.proof = model.proven_signs();
  if (findings.certificate() != nullptr) add_responses(model, findings);
  if (findings.proven()) return findings;
  const SearchedModel searched = searched_model(model);
  findings.search = search_counterexample(searched, seed, seconds);
  findings.ways = searched.ways;
  return findings;
}

static const char* verdict_of(const Findings& findings) {
  return findings.proven() ? "proven" : (findings.search.found ? "counterexample" : "neither");
}

double least_thrust_slope(const Findings& findings) {
  return findings.certificate()->held_thrust_slope + findings.thrust->residual_least[0];
}

static void add_thrust(const BlockModel& model, const Findings& findings, nlohmann::json& report) {
  if (!findings.thrust) return;
  report["thrust_slope"] = findings.certificate()->thrust_slope;
  report["held_thrust_slope"] = findings.certificate()->held_thrust_slope;
  report["airframe_thrust_slope"] = hover_thrust_slope(model.airframe());
  report["least_thrust_slope"] = least_thrust_slope(findings);  // null where nobody can bound it
}

std::optional<std::array<double, 4>> bias_time_constants_s(const BlockModel& model) {
  return model.with([](const auto& own) {
    std::optional<std::array<double, 4>> times_s;
    if (!own.records().has_bias) return times_s;
    times_s.emplace();
    for (std::size_t k = 0; k < 4; ++k) (*times_s)[k] = static_cast<double>(own.records().bias_time_constants_s[k]);
    return times_s;
  });
}

nlohmann::json findings_json(const BlockModel& model, const Findings& findings) {
  nlohmann::json report = {{"model", model.path()},
                           {"answer", model.answer()},
                           {"airframe", model.airframe_name()},
                           {"verdict", verdict_of(findings)}};
  if (findings.proven()) {
    report["argument"] = in_words(*findings.proof);
    report["inputs"] = "all finite features";
    report["slope"] = by_axis(findings.proof->slope);
    report["held_slope"] = by_axis(findings.proof->held_slope);
    report["airframe_slope"] = by_axis(hover_slopes(model.airframe()));
  }
  if (findings.certificate() != nullptr) {
    report["residual_lower"] = findings.certificate()->residual_lower;
    report["residual_upper"] = findings.certificate()->residual_upper;
    report["command_bound"] = findings.certificate()->command_bound;
    if (const auto times_s = bias_time_constants_s(model)) {
      report["bias"] = {{"time_constants_s", *times_s}, {"widens_command_bound", largest_bias(model.airframe())}};
    }
    add_thrust(model, findings, report);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& response = findings.with_rates[axis];
      if (response) report["held_slope_with_body_rates"][axis_names[axis]] = response->least(axis + 1);
    }
    if (std::isfinite(findings.certificate()->rounding)) {
      const double* step = findings.certificate()->sure_step;
      report["rounding"] = findings.certificate()->rounding;
      report["sure_step"] = by_axis({step[0], step[1], step[2]});
    }
  }
  if (!findings.proven()) {
    if (!findings.uncounted.empty()) report["uncounted_features"] = findings.uncounted;
    report["evaluations"] = findings.search.evaluations;
    report["seconds"] = findings.search.seconds;
    for (std::size_t way = 0; way < findings.ways.size(); ++way) {
      const AskedMore& asked = findings.ways[way];
      report[asked.held ? "least_held_derivative" : "least_derivative"][axis_names[asked.axis]] =
          findings.search.least[way];
    }
  }
  if (!findings.proven() && findings.search.found) {
    const Counterexample& found = *findings.search.found;
    nlohmann::json features = nlohmann::json::object();
    for (std::size_t i = 0; i < found.x.size(); ++i) features[findings.names[i]] = found.x[i];
    nlohmann::json moved = nlohmann::json::array();
    for (const std::size_t place : found.asked.places) moved.push_back(findings.names[place]);
    report["counterexample"] = {{"axis", axis_names[found.asked.axis]},
                                {"features", features},
                                {"moved", moved},
                                {"step", found.step},
                                {"derivative", found.derivative},
                                {"signed_sum", found.sum},
                                {"signed_sum_after_step", found.sum_of_more}};
  }
  return report;
}

}  // namespace programs
