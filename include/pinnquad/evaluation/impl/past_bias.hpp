// SPDX-License-Identifier: MIT
// Bodies of past_bias.hpp.
#pragma once

#include "pinnquad/evaluation/past_bias.hpp"

namespace pinnquad {

PINNQUAD_BODY std::vector<Commands<double>> with_past_bias(const RowSet& rows,
                                                           const std::vector<Commands<double>>& predictions,
                                                           const Airframe<double>& airframe,
                                                           const BiasSettings<double>& settings, double delay_s) {
  std::vector<Commands<double>> result = predictions;
  detail::each_past_bias(rows, predictions, airframe, settings, delay_s,
                         [&](std::size_t row, const auto& bias) { bias.add_to(result[row]); });
  return result;
}

PINNQUAD_BODY BiasTrial try_biases(const RowSet& rows, const std::vector<Commands<double>>& predictions,
                                   const Airframe<double>& airframe, const BiasTrial::Past& past) {
  constexpr double rounding = 1e-9;  // 2 (0.06 + 0.04 + 0.05) is more than 0.3
  BiasTrial trial;
  for (std::size_t c = 0; c < BiasTrial::candidates; ++c) {
    const double time_s = bias_time_constants_tried_s[c];
    if (time_s > 0 && time_s < (1 - rounding) * past.least_time_constant_s) {
      trial.absolute[c].fill(std::numeric_limits<double>::infinity());
      continue;
    }
    const auto settings = detail::bias_settings_of<double>(SignedSums<double>{time_s, time_s, time_s, time_s});
    detail::each_past_bias(rows, predictions, airframe, settings, past.delay_s, [&](std::size_t row, const auto& bias) {
      const SignedSums<double> residual = bias.residual(rows[row].commands, predictions[row]);
      if (!all_finite(residual)) return;
      trial.rows += c == 0 ? 1 : 0;
      for (std::size_t k = 0; k < 4; ++k) trial.absolute[c][k] += std::abs(residual[k] - bias.sums()[k]);
    });
  }
  return trial;
}

PINNQUAD_BODY SignedSums<double> chosen_bias_time_constants_s(const AskedModel& model, const RowSet& rows) {
  const BiasTrial::Past past{flown_motion_age_s, least_bias_time_constant_s(model.airframe.rotor_time_constant_s)};
  return try_biases(rows, predicted_commands(model, rows), model.airframe, past).best_s();
}

PINNQUAD_BODY SignedSums<double> BiasTrial::best_s() const {
  constexpr double most_cost = 0.05;
  SignedSums<double> best{};
  if (!(rows > 0)) return best;
  best.fill(bias_time_constants_tried_s.back());
  for (std::size_t k = 0; k < 4; ++k) {
    double least = absolute[0][k];
    for (const SignedSums<double>& of_candidate : absolute) least = std::min(least, of_candidate[k]);
    for (std::size_t c = candidates; c-- > 1;) {
      if (absolute[c][k] <= (1 + most_cost) * least) best[k] = bias_time_constants_tried_s[c];
    }
  }
  return best;
}

}  // namespace pinnquad
