// SPDX-License-Identifier: MIT
#include "logs/command_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "logs/log_checks.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/regression/identification.hpp"

namespace pinnquad::logs {
namespace {

std::string hundredths(double value) { return number_text(std::round(100 * value) / 100 + 0.0); }  // no -0

std::string flights_in_words(const Dataset& flights) {
  constexpr std::size_t most_names = 3;
  std::string words = flights.size() == 1 ? "flight " : std::to_string(flights.size()) + " flights: ";
  for (std::size_t i = 0; i < std::min(flights.size(), most_names); ++i) {
    words += (i > 0 ? ", " : "") + printable(flights[i].name);
  }
  return words + (flights.size() > most_names ? " ..." : "");
}

/// "by roll 0.61, pitch 0.58, force 0.6": motions that tell it to half or better.
std::string evidence(const Identification& found) {
  constexpr std::array<const char*, 4> motions = {"roll", "pitch", "yaw", "force"};
  constexpr double loosest = 0.5;
  std::string words;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (!(found.curve_by[i].half_width <= loosest)) continue;
    words += (words.empty() ? " by " : ", ") + (motions[i] + (" " + hundredths(found.curve_by[i].value)));
  }
  return words;
}

}  // namespace

CommandCurve command_curve(const Dataset& flights, const std::optional<double>& stated) {
  constexpr double longest_s = 1200;
  const std::string overrule = "; --thrust-curve, `thrust_curve` in [motors] of a mapping, or --airframe overrules it";
  const std::string law = "thrust curve of the commands, (1 - k) u + k u^2: ";
  if (stated) return {*stated, false, law + "k = " + number_text(*stated) + ", as given, or as mapping or log says"};
  RowSet rows;
  for (const Flight& flight : flights.flights()) {
    const double end_s = flight.front().time_s + longest_s / static_cast<double>(flights.size());
    std::size_t end = flight.size();
    while (end > 0 && flight[end - 1].time_s > end_s) --end;
    rows.add(flight, {0, end});
  }
  IdentificationSettings settings;
  settings.fit_thrust_curve = true;
  settings.scope = IdentificationSettings::Scope::thrust_curve;
  const Identification found = identify(rows, axis_signs(airframe_value<PaperQuadrotor, double>()), settings);
  const Estimate& curve = found.thrust_curve;
  const std::string of = " in " + flights_in_words(flights) + evidence(found);
  const std::string is =
      "k = " + hundredths(curve.value) + " (" + hundredths(curve.low()) + " to " + hundredths(curve.high()) + ")";
  if (const auto k = told_curve(curve)) return {std::round(1e4 * *k) / 1e4, true, law + is + of + overrule};
  if (curve.half_width <= narrow_curve) return {0, false, law + "straight, k = 0 taken: " + is + of + overrule};
  return {0, false,
          law + "not determined" + of +
              ": thrust proportional to the command is assumed, which a throttle is not; fly climbs with full power "
              "and hard rolls" +
              overrule};
}

}  // namespace pinnquad::logs
