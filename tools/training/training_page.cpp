// SPDX-License-Identifier: MIT
#include "training/training_page.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "command_line/in_words.hpp"
#include "command_line/like_warnings.hpp"
#include "command_line/listed.hpp"
#include "page/page.hpp"
#include "training/drawings.hpp"
#include "training/pictures.hpp"
#include "training/watched_flight.hpp"

namespace programs {

std::vector<const Predictions*> shown_predictions(const TrainingPage& in, std::size_t kind) {
  return detail::predictions_of_seed(in.plan, in.fits, kind, in.judged.kinds[kind].seeds.front());
}

namespace detail {
namespace {

/// The exported kind, the simpler kind nearest to it, the best that looks ahead.
std::vector<std::size_t> shown_kinds(const TrainingPage& in) {
  std::vector<std::size_t> shown;
  const auto show = [&shown](std::size_t k) {
    if (std::find(shown.begin(), shown.end(), k) == shown.end() && shown.size() < most_shown_kinds) shown.push_back(k);
  };
  const std::vector<std::size_t> causal = ranking(in.judged, false), centred = ranking(in.judged, true);
  if (in.exported) show(*in.exported);
  if (in.dynamics != nullptr) show(in.dynamics->kind);
  if (!causal.empty()) show(causal.front());
  if (!shown.empty()) {
    const AgainstSimpler* nearest = nullptr;
    for (const AgainstSimpler& against : in.verdicts[shown.front()].against) {
      if (nearest == nullptr || against.flights.baseline_mean < nearest->flights.baseline_mean) nearest = &against;
    }
    if (nearest != nullptr) show(nearest->simpler);
  }
  if (!centred.empty()) show(centred.front());
  return shown;
}

std::string shown_figure(const std::vector<double>& values, double scale, int decimals) {
  const pinnquad::Summary s = pinnquad::summarize(values);
  return shown::number(scale * s.mean, decimals) +
         (s.count > 1 && std::isfinite(s.deviation) ? " ± " + shown::number(scale * s.deviation, decimals) : "");
}

const char* badge_of(Standing standing) {
  switch (standing) {
    case Standing::success: return "reproduced";
    case Standing::undecided: return "undecided";
    case Standing::reference: return "open";
    default: return "not";
  }
}

/// Without and with a bias of the past; false where no rows chose its time constants.
nlohmann::json adaptive_json(const JudgedKind& kind) {
  if (!kind.bias_time_constants_s) return false;
  const ErrorFigure &r2 = error_figures[0], &absolute = error_figures[4];
  nlohmann::json times = nlohmann::json::array();
  for (const double time_s : *kind.bias_time_constants_s) {
    times.push_back(time_s > 0 ? shown::number(time_s, 2) : std::string("none"));
  }
  return {{"r2", shown_figure(over_seeds(kind, r2), 1, 3)},
          {"r2_with", shown_figure(over_seeds_adaptive(kind, r2), 1, 3)},
          {"error", shown_figure(over_seeds(kind, absolute), 1e3, 1)},
          {"error_with", shown_figure(over_seeds_adaptive(kind, absolute), 1e3, 1)},
          {"times", std::move(times)}};
}

nlohmann::json table_rows(const TrainingPage& in, bool centred) {
  nlohmann::json rows = nlohmann::json::array();
  for (const std::size_t k : ranking(in.judged, centred)) {
    const JudgedKind& kind = in.judged.kinds[k];
    nlohmann::json row = {{"title", kind.kind.title},
                          {"key", kind.kind.key},
                          {"sees", word_of(kind.kind.reach)},
                          {"exported", in.exported == k},
                          {"planned", centred},
                          {"r2", shown_figure(over_seeds(kind, error_figures[0]), 1, 3)},
                          {"rmse", shown_figure(over_seeds(kind, error_figures[3]), 1e3, 1)},
                          {"badge", badge_of(in.verdicts[k].standing)},
                          {"standing", word_of(in.verdicts[k].standing)},
                          {"sentence", in.verdicts[k].sentence}};
    row["figures"] = nlohmann::json::array();
    for (std::size_t i = 0; i < error_figures.size(); ++i) {
      std::string label = error_figures[i].title;
      if (label.find("R^2") == 0) label.replace(0, 3, "R²");
      row["figures"].push_back(
          {{"text", shown_figure(over_seeds(kind, error_figures[i]), i < 3 ? 1 : 1e3, i < 3 ? 3 : 1)},
           {"label", label}});
    }
    row["adaptive"] = adaptive_json(kind);
    const auto mean_of = [&](double (*of)(const Judgement&, std::size_t)) { return axis_means(kind, of); };
    const AxisFigures wrong = mean_of([](const Judgement& j, std::size_t i) { return j.derivatives.wrong_share[i]; });
    const AxisFigures least =
        mean_of([](const Judgement& j, std::size_t i) { return j.derivatives.least[i] / j.nominal_slopes[i]; });
    const AxisFigures median =
        mean_of([](const Judgement& j, std::size_t i) { return j.derivatives.median[i] / j.nominal_slopes[i]; });
    const AxisFigures large = mean_of([](const Judgement& j, std::size_t i) { return j.pairs.large[i]; });
    const AxisFigures angle = mean_of([](const Judgement& j, std::size_t i) { return j.axes[i].angle_difference_deg; });
    const AxisFigures slope = mean_of([](const Judgement& j, std::size_t i) { return j.axes[i].slope_error; });
    const AxisFigures pearson =
        mean_of([](const Judgement& j, std::size_t i) { return j.axes[i].predicted_correlation; });
    row["slopes"] = row["pairs"] = row["ellipses"] = nlohmann::json::array();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row["pairs"].push_back(shown::number(100 * large[axis], 1));
      row["ellipses"].push_back({{"angle", shown::number(angle[axis], 2)},
                                 {"slope", shown::number(100 * slope[axis], 1)},
                                 {"correlation", shown::number(pearson[axis], 3)}});
      if (!sees_acceleration(kind)) continue;
      row["slopes"].push_back({{"axis", axis_names[axis]},
                               {"wrong", shown::number(100 * wrong[axis], 2)},
                               {"is_wrong", wrong[axis] > 0},
                               {"least", shown::number(least[axis], 2)},
                               {"median", shown::number(median[axis], 2)}});
    }
    row["motors"] = nlohmann::json::array();
    for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
      row["motors"].push_back({{"r2", shown_figure(over_seeds(kind, error_figures[0], motor), 1, 3)},
                               {"rmse", shown_figure(over_seeds(kind, error_figures[3], motor), 1e3, 1)}});
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Errors of the shown kinds over what the logs have of speed, battery and height.
std::vector<ErrorsOver> errors_over(const TrainingPage& in, const std::vector<std::size_t>& shown) {
  std::vector<ErrorsOver> all = {
      {"speed", "m/s", {}, {}, {}}, {"battery", "V", {}, {}, {}}, {"height", "m", {}, {}, {}}};
  std::vector<std::vector<const Predictions*>> predictions;
  for (const std::size_t k : shown) predictions.push_back(shown_predictions(in, k));
  for (ErrorsOver& over : all) {
    over.error.resize(shown.size());
    over.square.resize(shown.size());
  }
  std::vector<bool> known = {!in.dataset.lacks("velocity"), true, !in.dataset.lacks("altitude")};
  for (std::size_t fold = 0; fold < in.plan.folds.size(); ++fold) {
    std::size_t at = 0;
    for (const pinnquad::FlightRows& piece : in.plan.folds[fold].split.test.pieces()) {
      const pinnquad::ExtraColumn* battery = piece.flight->column("battery_voltage");
      known[1] = known[1] && battery != nullptr;
      for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row, ++at) {
        if (!in.judged.counts[fold][at]) continue;
        const pinnquad::Sample& sample = (*piece.flight)[row];
        const double values[] = {sample.velocity_m_s.norm(), battery != nullptr ? battery->values[row] : 0,
                                 sample.altitude_m};
        for (std::size_t q = 0; q < all.size(); ++q) {
          all[q].value.push_back(values[q]);
          for (std::size_t i = 0; i < shown.size(); ++i) {
            double mean = 0, square = 0;
            for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
              const double error = (*predictions[i][fold])[at][motor] - sample.commands[motor];
              mean += error / pinnquad::rotor_count;
              square += error * error / pinnquad::rotor_count;
            }
            all[q].error[i].push_back(mean);
            all[q].square[i].push_back(square);
          }
        }
      }
    }
  }
  std::vector<ErrorsOver> result;
  for (std::size_t q = 0; q < all.size(); ++q) {
    if (known[q]) result.push_back(std::move(all[q]));
  }
  return result;
}

/// Command sums of the rows that count, flown and predicted.
std::array<AxisSeries, 3> counted_series(const TrainingPage& in, std::size_t kind) {
  const pinnquad::GivenAirframe airframe{in.plan.airframe.name, in.plan.airframe.value};
  const auto predictions = shown_predictions(in, kind);
  std::array<AxisSeries, 3> all;
  for (std::size_t fold = 0; fold < in.plan.folds.size(); ++fold) {
    const auto of_fold = axis_series(airframe, in.plan.folds[fold].split.test, *predictions[fold]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < of_fold[axis].target.size(); ++i) {
        if (!in.judged.counts[fold][i]) continue;
        all[axis].angular_acceleration.push_back(of_fold[axis].angular_acceleration[i]);
        all[axis].target.push_back(of_fold[axis].target[i]);
        all[axis].predicted.push_back(of_fold[axis].predicted[i]);
      }
    }
  }
  return all;
}

/// Speed and the rest at a moment, as far as the logs have it.
std::string facts_of(const WorstMoment& moment, const pinnquad::logs::ImportedDataset& dataset) {
  const MomentFacts facts = facts_at((*moment.flight)[moment.row]);
  const pinnquad::ExtraColumn* battery = moment.flight->column("battery_voltage");
  std::string text =
      "error " + shown::number(1e3 * moment.error, 1) + " ×10⁻³, most on u" + std::to_string(moment.motor + 1);
  if (!dataset.lacks("velocity")) text += " · speed " + shown::number(facts.speed_m_s, 1) + " m/s";
  text += " · tilt " + shown::number(facts.tilt_deg, 0) + "°";
  if (!dataset.lacks("altitude")) text += " · height " + shown::number(facts.altitude_m, 1) + " m";
  if (battery != nullptr) text += " · battery " + shown::number(battery->values[moment.row], 2) + " V";
  return text;
}

nlohmann::json moments_json(const TrainingPage& in, const std::vector<std::size_t>& shown) {
  constexpr std::size_t told = 8, drawn = 4;
  nlohmann::json list = nlohmann::json::array();
  const auto moments = worst_moments(in.plan.folds, shown_predictions(in, shown.front()), in.judged.counts, told);
  for (const WorstMoment& moment : moments) {
    const pinnquad::Sample& sample = (*moment.flight)[moment.row];
    const auto watched = in.watched.find(moment.flight->name);
    const double from_s = std::max(0.0, sample.time_s - watched_from_s(*moment.flight) - 1);
    nlohmann::json one = {{"flight", moment.flight->name},
                          {"time", shown::number(sample.time_s, 2)},
                          {"motor", "u" + std::to_string(moment.motor + 1)},
                          {"facts", facts_of(moment, in.dataset)},
                          {"happened", what_happened(moment, in.dataset)},
                          {"watch", watched == in.watched.end() ? "" : watched->second + in_words("#t=%.2f", from_s)},
                          {"drawing", false}};
    if (list.size() < drawn) {
      std::vector<const Predictions*> predictions;
      for (const std::size_t k : shown) predictions.push_back(shown_predictions(in, k)[moment.fold]);
      for (const pinnquad::FlightRows& piece : in.plan.folds[moment.fold].split.test.pieces()) {
        if (piece.flight == moment.flight) {
          one["drawing"] = inline_chart(moment_chart(moment, piece, in.judged, shown, predictions));
        }
      }
    }
    list.push_back(std::move(one));
  }
  return list;
}

nlohmann::json folds_json(const FitPlan& plan) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Fold& fold : plan.folds) {
    rows.push_back({{"held_out", (fold.by_time ? "the end of " : "") + listed(fold.held_out)},
                    {"held_out_rows", fold.split.test.size()},
                    {"validation", (fold.part_validates ? "last fifth of " : "") + listed(fold.validation)},
                    {"validation_rows", fold.split.validation.size()},
                    {"train", listed(fold.train)},
                    {"train_rows", fold.split.train.size()}});
  }
  return rows;
}

/// The proof of the export's signs; false where there is none.
nlohmann::json certificate_json(const nlohmann::json& report) {
  const nlohmann::json& proven = report["certificate"];
  if (!proven.is_object()) return false;
  nlohmann::json told = {{"rows", nlohmann::json::array()}, {"bound", proven["in_words"]}};
  told["bias"] = proven.value("bias_in_words", "");
  const auto row = [&told, &proven](const std::string& name, double slope, double own, const char* unit) {
    const nlohmann::json& known = proven["known"][name];
    std::string interval = "unknown", by = "";
    if (known.is_object()) {
      const auto share = [&](std::size_t i) { return shown::number(known["interval_95"][i].get<double>() / own, 2); };
      interval = share(0) + " to " + share(1);
      by = known["by"].get<std::string>();
    }
    told["rows"].push_back({{"name", name},
                            {"slope", shown::number(slope, 6)},
                            {"unit", unit},
                            {"ratio", shown::number(slope / own, 2)},
                            {"interval", interval},
                            {"by", by}});
  };
  for (const char* axis : axis_names) row(axis, proven["slope"][axis], proven["airframe_slope"][axis], "s²/rad");
  told["thrust"] = proven.contains("thrust_slope");
  if (told["thrust"]) row("thrust", proven["thrust_slope"], proven["airframe_thrust_slope"], "s²/m");
  return told;
}

/// Shares of the held-out rows that the guard declines, by reason; false where nothing was judged.
nlohmann::json guard_told(const TrainingPage& in) {
  if (in.dynamics == nullptr) return false;
  const GuardCounts& guard = in.dynamics->guard;
  const auto percent = [&guard](std::uint64_t count) { return shown::number(100 * guard.share_of(count), 1); };
  nlohmann::json rows = nlohmann::json::array();
  const auto row = [&](const std::string& reason, std::uint64_t count, const std::string& more = "") {
    rows.push_back({{"reason", reason}, {"share", percent(count)}, {"more", more}});
  };
  std::vector<std::pair<std::string, std::uint64_t>> features(guard.furthest.begin(), guard.furthest.end());
  std::stable_sort(features.begin(), features.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string furthest;
  constexpr std::size_t most_told = 5;
  for (std::size_t i = 0; i < std::min(features.size(), most_told); ++i) {
    add_to_list(furthest, features[i].first + " " + percent(features[i].second) + " %");
  }
  row("answered", guard.answered());
  row("outside the envelope of the training rows", guard.outside_envelope,
      furthest.empty() ? "" : "furthest out: " + furthest);
  row("no whole window of instants yet", guard.warming_up);
  row("commands that are no numbers", guard.output_not_finite);
  return {{"rows", rows}, {"beyond", percent(guard.beyond_limits)}, {"count", guard.rows}};
}

/// Time, frequency response, noise; false where there are none.
nlohmann::json dynamics_told(const TrainingPage& in) {
  if (in.dynamics == nullptr) return false;
  const HeldOutDynamics& dynamics = *in.dynamics;
  const JudgedKind& kind = in.judged.kinds[dynamics.kind];
  const std::string model = kind.kind.title;
  nlohmann::json told = {{"name", model}, {"why_not", dynamics.why_not}};
  if (dynamics.typical.size > 0) {
    const HeldOutStretch& typical = dynamics.typical;
    const auto predictions = predictions_of_seed(in.plan, in.fits, dynamics.kind, dynamics.seed);
    told["stretch"] = {{"flight", typical.flight->name},
                       {"from", shown::number((*typical.flight)[typical.row].time_s, 1)},
                       {"drawing", inline_chart(stretch_chart(typical, model, *predictions[typical.fold],
                                                              sum_signs(in.plan.airframe.value)))}};
  }
  if (!dynamics.has_spectra()) return told;
  nlohmann::json sums = nlohmann::json::array(), motors = nlohmann::json::array();
  const auto with_error = [](double value, double error, int decimals) {
    return shown::number(value, decimals) + " ± " + shown::number(error, decimals);
  };
  for (std::size_t sum = 0; sum < sum_names.size(); ++sum) {
    const FollowedRange& followed = dynamics.followed[sum];
    const bool any = followed.to_hz > 0;
    sums.push_back(
        {{"name", sum_names[sum]},
         {"range", any ? shown::number(followed.from_hz, 2) + " to " + shown::number(followed.to_hz, 1) : "nowhere"},
         {"gain", any ? with_error(followed.gain, 2 * followed.gain_error, 3) : "–"},
         {"delay", any ? with_error(1e3 * followed.delay_s, 2e3 * followed.delay_error_s, 1) : "–"}});
  }
  const NoiseCeiling& ceiling = dynamics.ceiling;
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    const double r2 = pinnquad::summarize(over_seeds(kind, error_figures[0], motor)).mean;
    motors.push_back({{"name", "u" + std::to_string(motor + 1)},
                      {"r2", shown::number(r2, 3)},
                      {"ceiling", shown::number(ceiling.r2[motor], 3)},
                      {"noise", shown::number(1e3 * std::sqrt(ceiling.density[motor] * 0.5 / dynamics.period_s), 1)},
                      {"model", in.judged.kinds[ceiling.kind[motor]].kind.title}});
  }
  told["spectra"] = {{"response", inline_chart(response_chart(dynamics))},
                     {"residual", inline_chart(residual_chart(dynamics, model))},
                     {"sums", sums},
                     {"motors", motors},
                     {"ceiling", shown::number(mean_over_motors(ceiling.r2), 3)},
                     {"white", ceiling.white},
                     {"from_hz", shown::number(NoiseCeiling::from_share * 0.5 / dynamics.period_s, 1)},
                     {"to_hz", shown::number(0.5 / dynamics.period_s, 1)},
                     {"segment", shown::number(dynamics.segment_s, 1)},
                     {"segments", dynamics.segments}};
  return told;
}

/// Its limits of trust: their file, or why there are none; false where nothing was exported.
nlohmann::json trust_json(const nlohmann::json& report) {
  const nlohmann::json& trust = report["trust"];
  if (!trust.is_object()) return false;
  return {{"file", trust["file"]}, {"why_not", trust["why_not"]}};
}

/// Numbers of the vehicle that the flights identify, with their intervals; false where they were not asked.
nlohmann::json vehicle_told(const nlohmann::json& report) {
  if (!report.contains("vehicle") || !report["vehicle"].is_object()) return false;
  const nlohmann::json& vehicle = report["vehicle"];
  nlohmann::json told = {{"rows", nlohmann::json::array()},
                         {"contradicted", vehicle["contradicted"]},
                         {"why_not", vehicle["not_identified_because"]}};
  const auto text = [](const nlohmann::json& number) {
    return number.is_number() ? in_words("%.3g", number.get<double>()) : "–";
  };
  for (const auto& [key, number] : vehicle["numbers"].items()) {
    told["rows"].push_back({{"name", key},
                            {"value", text(number["value"])},
                            {"interval", text(number["low"]) + " to " + text(number["high"])},
                            {"unit", number["unit"]},
                            {"excitation", number["excitation"]},
                            {"fly", number.value("fly", "")}});
  }
  return told;
}

nlohmann::json lines_of(const std::string& text) {
  nlohmann::json lines = nlohmann::json::array();
  std::istringstream rest(text);
  for (std::string line; std::getline(rest, line);) lines.push_back(line);
  return lines;
}

/// The verdict; false where there is none.
nlohmann::json found_json(const TrainingPage& in) {
  if (in.found == nullptr) return false;
  const auto shown = [](std::string text) {
    for (std::size_t at; (at = text.find("R^2")) != std::string::npos;) text.replace(at, 3, "R²");
    return text;
  };
  return {{"may_fly", word_of(in.found->may_fly())},
          {"short", in.found->short_words()},
          {"why", shown(in.found->why())},
          {"evidence", in.found->reasons().empty() ? "" : shown(in.found->evidence())},
          {"next", in.found->next()}};
}

/// The path flown with the model and without it, and the error over time; false where it did not fly.
nlohmann::json flown_path(const TrainingPage& in) {
  const nlohmann::json& flown = in.report["closed_loop"];
  if (in.traces == nullptr || in.traces->model.time_s.empty() || !flown.contains("model")) return false;
  const auto centimetres = [&](const char* who) { return shown::number(100 * flown[who]["rmse_m"].get<double>(), 1); };
  return {{"drawing", inline_chart(path_chart(*in.traces))},
          {"with", centimetres("model")},
          {"without", centimetres("without_jerk")},
          {"answered", shown::number(100 * flown["model"]["answered_share"].get<double>(), 1)}};
}

}  // namespace
}  // namespace detail

std::string training_page(const TrainingPage& in) {
  constexpr std::size_t most_named = 6;  // held-out flights in the first sentence; all are in the last section
  const std::vector<std::size_t> shown = detail::shown_kinds(in);
  std::size_t rows = 0;
  for (const std::size_t of_fold : in.judged.rows) rows += of_fold;
  nlohmann::json page = {
      {"title", "What the models of these flights are worth"},
      {"held_out", in.judged.flights.size() <= most_named ? listed(in.judged.flights) : ""},
      {"flight_count", std::to_string(in.judged.flights.size()) +
                           (in.judged.flights.size() == 1 ? " held-out flight" : " held-out flights")},
      {"rows", rows},
      {"all_rows", in.dataset.flights.rows()},
      {"seeds", in.plan.seeds},
      {"rotated", in.plan.folds.size() > 1},
      {"by_time", in.plan.folds.front().by_time},
      {"logged", !in.dataset.mapping.empty() || !in.dataset.steps.empty()},
      {"fewest_pairs", fewest_pairs},
      {"can_decide", in.judged.flights.size() >= fewest_pairs},
      {"found", detail::found_json(in)},
      {"flown_path", detail::flown_path(in)},
      {"inputs", detail::lines_of(in.inputs)},
      {"export_sentence", in.export_sentence},
      {"airframe", in.plan.airframe.name},
      {"bias_delay", shown::number(1e3 * in.plan.past.delay_s, 0)},
      {"bias_least", shown::number(in.plan.past.least_time_constant_s, 2)},
      {"causal", detail::table_rows(in, false)},
      {"centred", detail::table_rows(in, true)},
      {"ranked", nlohmann::json::array()},
      {"not_applicable", nlohmann::json::array()},
      {"folds", detail::folds_json(in.plan)},
      {"steps", nlohmann::json::array()},
      {"notes", in.dataset.notes},
      {"warnings", collapsed(in.report["warnings"], "report.json has all")},
      {"period", shown::number(1e3 * in.dataset.sample_period_s, 1)},
      {"lag", shown::number(1e3 * in.dataset.lag_removed_s, 0)},
      {"absent", listed(in.dataset.absent)},
      {"certificate", detail::certificate_json(in.report)},
      {"trust", detail::trust_json(in.report)},
      {"guard", detail::guard_told(in)},
      {"vehicle", detail::vehicle_told(in.report)},
      {"dynamics", detail::dynamics_told(in)},
      {"moments", nlohmann::json::array()},
      {"watched", !in.watched.empty()}};
  for (const char* reach : {"causal", "centred"}) {
    for (const nlohmann::json& row : page[reach]) page["ranked"].push_back(row);
  }
  for (const JudgedKind& kind : in.judged.kinds) {
    if (!kind.applicable())
      page["not_applicable"].push_back({{"title", kind.kind.title}, {"reason", kind.not_applicable}});
  }
  for (const pinnquad::logs::ImportStep& step : in.dataset.steps) {
    page["steps"].push_back({{"step", step.name},
                             {"before", step.rows_before},
                             {"after", step.rows_after},
                             {"lost", step.rows_before - std::min(step.rows_before, step.rows_after)},
                             {"told", step.told}});
  }
  if (in.report["closed_loop"].contains("model")) {
    const nlohmann::json& flown = in.report["closed_loop"];
    page["closed_loop"] = {{"period", shown::number(flown["period_s"], 1)},
                           {"answered", shown::number(100 * flown["model"]["answered_share"].get<double>(), 1)},
                           {"flown", nlohmann::json::array()},
                           {"sums", nlohmann::json::array()}};
    for (const auto& [sum, figures] : flown["against_formula"].items()) {
      page["closed_loop"]["sums"].push_back({{"name", sum},
                                             {"slope", shown::number(figures["slope"], 2)},
                                             {"difference", shown::number(figures["rms_difference"], 3)},
                                             {"spread", shown::number(figures["spread"], 3)}});
    }
    const std::pair<const char*, const char*> policies[] = {
        {"model", "the exported model"},
        {"formula", "the vehicle's analytic inverse"},
        {"without_jerk", "the same, without jerk and snap of the path"}};
    for (const auto& [key, name] : policies) {
      page["closed_loop"]["flown"].push_back(
          {{"name", name},
           {"rmse", shown::number(100 * flown[key]["rmse_m"].get<double>(), 1)},
           {"largest", shown::number(100 * flown[key]["largest_error_m"].get<double>(), 1)},
           {"time", shown::number(flown[key]["flown_s"], 0)},
           {"status", flown[key]["status"]}});
    }
  }
  if (in.exported) {
    const JudgedKind& kind = in.judged.kinds[*in.exported];
    const KindVerdict& verdict = in.verdicts[*in.exported];
    const bool has_ceiling = in.dynamics != nullptr && in.dynamics->has_spectra();
    page["headline"] = {
        {"ceiling", has_ceiling ? shown::number(mean_over_motors(in.dynamics->ceiling.r2), 3) : ""},
        {"answered", in.dynamics != nullptr ? shown::number(100 * in.dynamics->guard.answered_share(), 1) : ""},
        {"title", kind.kind.title},
        {"r2", shown::number(detail::r2_of(kind), 3)},
        {"unbiased", shown::number(pinnquad::summarize(over_seeds(kind, error_figures[1])).mean, 3)},
        {"rmse", shown::number(1e3 * pinnquad::summarize(over_seeds(kind, error_figures[3])).mean, 1)},
        {"standing", word_of(verdict.standing)},
        {"sentence", verdict.sentence}};
  }
  if (!shown.empty()) {
    std::vector<EllipsesOf> ellipses;
    for (const std::size_t k : shown) {
      ellipses.push_back({in.judged.kinds[k].kind.title, detail::counted_series(in, k)});
    }
    page["shown"] = {{"name", in.judged.kinds[shown.front()].kind.title},
                     {"flights", inline_chart(flights_chart(in.judged, shown))},
                     {"over", inline_chart(errors_over_chart(in.judged, shown, detail::errors_over(in, shown)))},
                     {"ellipses", inline_chart(ellipses_chart(ellipses))}};
    page["moments"] = detail::moments_json(in, shown);
  }
  return text_page("training_page.html", page);
}

}  // namespace programs
