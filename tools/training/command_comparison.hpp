// SPDX-License-Identifier: MIT
// The commands of a model beside those of the vehicle's own formula, tick by tick, for the motions that a feedback loop
// asks of both: a loop's error hides what its feedback makes good, the signed sums of the commands hide nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/in_words.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "training/judgement.hpp"

namespace programs {

struct ComparedCommands {
  std::array<std::vector<double>, 4> model, formula;  ///< of each sum, tick by tick

  void take(const pinnquad::Airframe<double>& airframe, const pinnquad::Commands<double>& by_model,
            const pinnquad::Commands<double>& by_formula) {
    const auto signs = sum_signs(airframe);
    for (std::size_t sum = 0; sum < signs.size(); ++sum) {
      model[sum].push_back(pinnquad::signed_sum(signs[sum], by_model));
      formula[sum].push_back(pinnquad::signed_sum(signs[sum], by_formula));
    }
  }
};

/// A feed-forward policy whose answers are compared with another's; both are asked for the same motion. What its
/// fallback answers is left out.
template <class Policy, class Formula>
struct ComparedPolicy {
  Policy policy;
  Formula formula;
  pinnquad::Airframe<double> airframe;
  ComparedCommands* compared;  ///< outlives the flight

  pinnquad::Status operator()(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired,
                              std::uint64_t time_us, pinnquad::Commands<double>& commands) noexcept {
    const pinnquad::Status status = policy(state, desired, time_us, commands);
    pinnquad::Commands<double> other{};
    const bool own = status == pinnquad::Status::ok || status == pinnquad::Status::limited;
    if (own && has_output(formula(state, desired, time_us, other))) compared->take(airframe, commands, other);
    return status;
  }
  auto count() const noexcept { return policy.count(); }
};
template <class Policy, class Formula>
ComparedPolicy(Policy, Formula, pinnquad::Airframe<double>, ComparedCommands*) -> ComparedPolicy<Policy, Formula>;

/// By sum: root mean square of the difference but for a constant one, the formula's own spread, and the slope of the
/// model's over the formula's, whose sign is that of their correlation.
inline nlohmann::json comparison_json(const ComparedCommands& compared) {
  nlohmann::json result = nlohmann::json::object();
  for (std::size_t sum = 0; sum < sum_names.size(); ++sum) {
    if (compared.model[sum].size() < 2) continue;
    const auto moments = pinnquad::joint_moments(compared.formula[sum], compared.model[sum]);
    if (!(moments.variance_x > 0)) continue;
    const double apart = moments.variance_x + moments.variance_y - 2 * moments.covariance;
    result[sum_names[sum]] = {{"rms_difference", std::sqrt(std::max(apart, 0.0))},
                              {"spread", std::sqrt(moments.variance_x)},
                              {"slope", moments.covariance / moments.variance_x}};
  }
  return result;
}

/// "thrust 0.98 (0.011), roll 1.02 (0.004)": slopes, and differences.
inline std::string comparison_in_words(const nlohmann::json& comparison) {
  std::string words;
  for (const char* const sum : sum_names) {
    if (!comparison.contains(sum)) continue;
    words += in_words("%s%s %.2f (%.3f)", words.empty() ? "" : ", ", sum, comparison[sum]["slope"].get<double>(),
                      comparison[sum]["rms_difference"].get<double>());
  }
  return words;
}

/// "moves the roll sum of its commands against the formula's, slope -0.83"; empty where all move with it.
inline std::string turned_round(const nlohmann::json& comparison) {
  for (const char* const sum : sum_names) {
    if (!comparison.contains(sum) || comparison[sum]["slope"] > 0) continue;
    return in_words("moves the %s sum of its commands against the formula's, slope %.2f", sum,
                    comparison[sum]["slope"].get<double>());
  }
  return "";
}

}  // namespace programs
