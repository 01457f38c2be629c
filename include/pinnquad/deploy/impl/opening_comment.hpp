// SPDX-License-Identifier: MIT
// Bodies of opening_comment.hpp.
#pragma once

#include "pinnquad/deploy/opening_comment.hpp"

namespace pinnquad {
namespace detail {

/// No locale plays a part.
PINNQUAD_BODY std::string fixed_text(double value, int decimals) {
  char text[400];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr};
}

}  // namespace detail

PINNQUAD_BODY std::string known_slopes_in_words(const SlopesOfSums& slopes, double own_thrust, const AxisSlopes& own,
                                                int decimals) {
  constexpr std::array<const char*, 4> names = {"thrust", "roll", "pitch", "yaw"};
  std::string words;
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{0}}) {
    const MeasuredSlope& slope = slopes[k];
    if (!slope.known) continue;
    const double one = k == 0 ? own_thrust : own[k - 1];
    const auto share = [one, decimals](double value) { return detail::fixed_text(value / one, decimals); };
    words += std::string(words.empty() ? "" : ", ") + names[k] + " " + share(slope.lower) + " to " + share(slope.upper);
    if (slope.smoothed()) words += " (by smoothed rows; least squares " + share(slope.least_squares) + ")";
  }
  return words;
}

namespace detail {

PINNQUAD_BODY void write_comment(std::ostream& out, const std::string& text) {
  constexpr std::size_t widest = 117;  // beside "// "
  std::size_t from = 0;
  while (text.size() - from > widest) {
    std::size_t end = text.rfind(' ', from + widest);
    if (end == std::string::npos || end <= from) end = text.find(' ', from + widest);
    if (end == std::string::npos) break;
    out << "// " << text.substr(from, end - from) << '\n';
    from = end + 1;
  }
  out << "// " << text.substr(from) << '\n';
}

PINNQUAD_BODY void write_opening_comment(std::ostream& out, const WrittenRecords& records,
                                         const Airframe<double>& own) {
  const bool over_own = records.airframe_known;
  const AxisSlopes own_slopes = over_own ? hover_slopes(own) : AxisSlopes{1, 1, 1};
  const int decimals = over_own ? 2 : 4;
  if (records.fitness.empty() && records.verdict && records.verdict->worse_than_mean()) {
    out << "// NOT FOR FLIGHT: on rows that it was not trained on this model is worse than the mean of the commands.\n";
  }
  for (const std::string* said : {&records.fitness, &records.beside}) {
    if (!said->empty()) write_comment(out, printable(*said) + ".");
  }
  if (!over_own) {
    out << "// AIRFRAME ASSUMED: the flights do not tell the vehicle wholly; the analytic inverse is another one's.\n";
  }
  std::optional<AxisSlopes> slopes = records.proven_slopes;
  if (records.certificate) {
    const double* held = records.certificate->held_slope;
    slopes = {held[0], held[1], held[2]};
  }
  if (records.signs_unproven) {
    out << "// NOT PROVEN: it may command less torque where more angular acceleration is asked (pinnquad certify).\n";
  } else if (slopes) {
    const auto share = [&](std::size_t axis) { return fixed_text((*slopes)[axis] / own_slopes[axis], decimals); };
    out << "// PROVEN: each signed sum of the commands rises with the angular acceleration about its axis, for every "
           "input\n// (pinnquad certify). Slopes"
        << (over_own ? " over the airframe's own in hover" : " in s^2/rad") << ": roll " << share(0) << ", pitch "
        << share(1) << ", yaw " << share(2) << ".\n";
    if (records.facts.has_bias) {
      const Commands<double> most = largest_bias(own);
      out << "// With the bias that AdaptiveInverse learns in flight they hold as they are, for it is of the past; the "
             "bound of\n// each command widens by "
          << fixed_text(*std::max_element(most.begin(), most.end()), 4) << " at most.\n";
    }
  }
  const std::string known =
      known_slopes_in_words(records.slopes, over_own ? hover_thrust_slope(own) : 1, own_slopes, decimals);
  if (!known.empty()) out << "// Their 95 % intervals by the training rows: " << known << ".\n";
  const auto said = [](const char* before, double figure) {
    return is_finite(figure) ? before + fixed_text(figure, 3) : std::string();
  };
  if (records.verdict && is_finite(records.verdict->test_r_squared)) {
    out << "// On rows that it was not trained on: R^2 " << fixed_text(records.verdict->test_r_squared, 3)
        << said(", worst motor ", records.verdict->worst_motor_r_squared)
        << said(", linear regression ", records.verdict->linear_regression_r_squared) << ".\n";
  }
  if (records.verdict && is_finite(records.verdict->answered_share)) {
    out << "// Of those rows its guard let it answer " << fixed_text(100 * records.verdict->answered_share, 1)
        << " %.\n";
  }
}

}  // namespace detail
}  // namespace pinnquad
