// SPDX-License-Identifier: MIT
// May a model fly: the one verdict of train, convert, certify, evaluate, loop and the pages, by all that is known of
// the model (command_line/flight_verdict.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/flight_verdict.hpp"
#include "command_line/in_words.hpp"
#include "flight/block_loop.hpp"
#include "flight/loop_figures.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "training/certificate_words.hpp"
#include "training/command_comparison.hpp"

namespace programs {

/// R^2 on rows held out: below the first a model is not to be flown, below the second with care.
inline constexpr double least_r2 = 0.5, good_r2 = 0.8;

/// A slow path is flown as well without its jerk as with it: so much further off than the analytic inverse is no fault.
inline constexpr double slack_of_loops = 1.5;

/// Whether more angular acceleration asked is more torque commanded.
enum class Signs {
  proven,
  not_asked,  ///< the model is asked no angular acceleration
  unknown,    ///< nothing is proven, and no counterexample was looked for
  unrefuted,  ///< nothing is proven, and no counterexample was found
  refuted     ///< by two motions
};

/// All that the verdict on a model is made of. What was not looked at is as it is here.
struct ModelEvidence {
  std::string title;
  std::optional<pinnquad::Verdict> held_out;  ///< none: no flight judged it
  nlohmann::json flown;                       ///< by flight_evidence(); or `why_not`; null: it looks ahead
  std::string beaten{};                       ///< by a proven model of the same run by a tenth: how; empty: it is not
  Signs signs = Signs::proven;
  std::string refuted_about{};        ///< the axis
  bool known = true;                  ///< the vehicle: by --airframe, or the flights
  std::string flight{};               ///< to record where it is not
  std::vector<std::string> slopes{};  ///< by odd_slopes()
  bool last_commands_err_less = false;
  std::string rows = "the rows held out";  ///< that judged it
  std::string block = "model.block";       ///< its file, for the command to type next
};

/// A flight in the simulator as the verdict reads it.
inline nlohmann::json flight_evidence(const LoopFlights& flights, const std::string& trajectory) {
  nlohmann::json flown = {
      {"trajectory", trajectory == loop_trajectories.front() ? "figure-eight" : pinnquad::printable(trajectory)},
      {"half_length_m", flights.half_length_m},
      {"period_s", flights.period_s},
      {"formula", loop_figures(flights.analytic_inverse)},
      {"without_jerk", loop_figures(flights.without_jerk)},
      {"model", loop_figures(flights.model)},
      {"against_formula", nlohmann::json::object()}};
  flown["model"]["answered_share"] = answered_share(flights.model.fallback);
  return flown;
}

/// Why a model is not fit to fly by its flight in the simulator; empty if it is, or was not flown.
inline std::string unfit_to_fly(const nlohmann::json& flown) {
  constexpr double least_answered = 0.5;
  constexpr double least_m = 0.01;  // a path that hardly bends needs no model: what is nearer refuses none
  if (!flown.contains("model")) return "";
  const nlohmann::json& model = flown["model"];
  const std::string path = flown.value("trajectory", "figure-eight");
  if (lost_vehicle(flown)) {
    return in_words("loses the vehicle in the closed loop (%.1f m off)", model["largest_error_m"].get<double>());
  }
  if (model["answered_share"] < least_answered) {
    return in_words("answers %.1f %% of the %s", 100 * model["answered_share"].get<double>(), path.c_str());
  }
  const double rmse_m = model["rmse_m"];
  if (rmse_m > least_m && rmse_m > flown["without_jerk"]["rmse_m"] &&
      rmse_m > slack_of_loops * flown["formula"]["rmse_m"].get<double>()) {
    return in_words("flies a %s %.1f cm off; the analytic inverse without the path's jerk is %.1f cm off", path.c_str(),
                    100 * rmse_m, 100 * flown["without_jerk"]["rmse_m"].get<double>());
  }
  return turned_round(flown.value("against_formula", nlohmann::json::object()));
}

/// "3.1 cm off a figure-eight (analytic inverse 2.9 cm, without the path's jerk 5.2 cm)"; why there was none where it
/// was not flown.
inline std::string flight_in_words(const nlohmann::json& flown) {
  if (flown.is_null()) return "not flown here: it looks ahead";
  if (!flown.contains("model")) return "not flown here: " + flown["why_not"].get<std::string>();
  return in_words("%.1f cm off a %s (analytic inverse %.1f cm, without the path's jerk %.1f cm)",
                  100 * flown["model"]["rmse_m"].get<double>(), flown.value("trajectory", "figure-eight").c_str(),
                  100 * flown["formula"]["rmse_m"].get<double>(), 100 * flown["without_jerk"]["rmse_m"].get<double>());
}

inline std::string r2_in_words(const ModelEvidence& evidence) {
  if (!evidence.held_out) return "judged by no flight";
  return "R^2 " + decimals(evidence.held_out->test_r_squared, 3) + " on " + evidence.rows;
}

/// "R^2 0.912 on the rows held out, 3.1 cm off a figure-eight (...), signs proven": what a verdict is made of.
inline std::string evidence_in_words(const ModelEvidence& evidence) {
  constexpr const char* signs[] = {"signs proven", "asked no angular acceleration", "signs not proven",
                                   "signs neither proven nor refuted", "signs refuted"};
  return r2_in_words(evidence) + ", " + flight_in_words(evidence.flown) + ", " +
         signs[static_cast<std::size_t>(evidence.signs)];
}

inline FlightVerdict model_verdict(const ModelEvidence& evidence) {
  constexpr double least_answered = 0.9, usually_answered = 0.99;
  const std::string loop = "pinnquad loop " + evidence.block, airframe = "name the vehicle with --airframe FILE.toml";
  const std::string structured = "train a structured model: pinnquad train FLIGHTS --export structured";
  FlightVerdict verdict(evidence_in_words(evidence), evidence.title + ", ");
  const std::string unfit = unfit_to_fly(evidence.flown);
  const std::string r2 = r2_in_words(evidence);
  if (evidence.held_out && !(evidence.held_out->test_r_squared >= least_r2)) {
    verdict.refuse(evidence.title +
                       (evidence.held_out->worse_than_mean() ? " is worse than the mean of the commands ("
                                                             : " explains less than half of the commands' variance (") +
                       r2 + ")",
                   std::string(livelier_flight) + "; docs/low_r2.md");
  }
  if (!unfit.empty()) {
    verdict.refuse(evidence.title + " " + unfit,
                   std::string("fly the analytic inverse of the airframe, or ") + livelier_flight);
  }
  if (!evidence.beaten.empty()) verdict.refuse(evidence.beaten, "train again with that --export");
  if (!evidence.held_out) verdict.care("no flight judged it", "pinnquad evaluate " + evidence.block + " FLIGHTS");
  if (evidence.signs == Signs::refuted) {
    verdict.care("asked for more " + evidence.refuted_about + " acceleration, it may command less torque", structured);
  } else if (evidence.signs == Signs::unknown || evidence.signs == Signs::unrefuted) {
    verdict.care("no proof that more angular acceleration asked is more torque commanded",
                 evidence.signs == Signs::unrefuted
                     ? structured
                     : "pinnquad certify " + evidence.block + " looks for a counterexample");
  }
  if (!evidence.known) {
    verdict.care("the vehicle is not known, so its airframe is assumed",
                 airframe + (evidence.flight.empty() ? "" : ", or record: " + evidence.flight));
  }
  if (evidence.held_out) {
    if (evidence.held_out->test_r_squared < good_r2) {
      verdict.care(r2 + " is low", std::string(livelier_flight) + "; docs/low_r2.md");
    }
    if (evidence.held_out->has_poor_motor()) {
      verdict.care("one motor is predicted worse than by its mean (R^2 " +
                       decimals(evidence.held_out->worst_motor_r_squared, 3) + ")",
                   "look at that motor: docs/low_r2.md");
    }
  }
  for (const std::string& slope : evidence.slopes) verdict.care(slope, livelier_flight);
  if (evidence.last_commands_err_less) {
    verdict.care("the commands of 100 ms ago err less", "fly it with AdaptiveInverse (docs/adaptive.md)");
  }
  if (evidence.held_out && evidence.held_out->answered_share < least_answered) {
    verdict.care("its guard answers " + decimals(100 * evidence.held_out->answered_share, 0) + " % of " + evidence.rows,
                 "train on flights as fast as those that you will fly");
  }
  if (!evidence.flown.contains("model")) {
    verdict.care(flight_in_words(evidence.flown), evidence.flown.is_null() ? "plan its trajectories offline" : loop);
  } else if (evidence.flown["model"]["answered_share"] < usually_answered) {
    verdict.care("the analytic inverse flew " +
                     decimals(100 - 100 * evidence.flown["model"]["answered_share"].get<double>(), 1) + " % of the " +
                     evidence.flown.value("trajectory", "figure-eight"),
                 "train on flights as fast as this trajectory");
  }
  verdict.then(loop +
               " --controllers adaptive,indi --conditions calm,payload; then the bench, propellers off "
               "(docs/in_flight.md)");
  return verdict;
}

}  // namespace programs
