// SPDX-License-Identifier: MIT
// Limits of trust. A monotone model is fitted to a calm flight, limits of distance and command residual to others; then
// it meets calm flights, wind, gusts, a payload and another controller that neither has seen. Prints false alarms, and
// how well envelope, distance and command residual tell the rows on which the model errs three times as much as usual.
// `trust short` flies a few minutes instead of hours.
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/pinnquad.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"
#include "pinnquad/training/structured/trust_limits.hpp"

using namespace pinnquad;

namespace {

using Calm = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
using Windy = Quadrotor<double, StandardAtmosphere, ConstantWind, QuadraticDrag>;
using Gusty = Quadrotor<double, StandardAtmosphere, ConstantWind, DrydenTurbulence<>, QuadraticDrag>;
using Settings = Context<PhysicsFeatures, PaperQuadrotor, AxisCommandOutputs>;
using Residual = Mlp<float, InputSize<residual_inputs<PhysicsFeatures>>, Hidden<2, 32>, OutputSize<4>, Relu>;
using Model = TrainedModel<MonotonePredictor<PhysicsFeatures, Residual>, Settings>;

struct Scale {
  std::size_t rows = 15000;  ///< of a flight, 0.05 s apart
  int flights = 6;           ///< of each kind that is judged
  int validating = 3;
  int epochs = 100;
};

Airframe<double> airframe(double mass_share = 1) {
  Airframe<double> value = airframe_value<PaperQuadrotor, double>();
  value.mass_kg *= mass_share;
  return value;
}

template <class Vehicle>
Flight flown(const Vehicle& vehicle, unsigned seed, std::size_t rows, double stiffness = 1) {
  FlightPlan plan = AgileFlight::plan();
  plan.samples = rows;
  FlightGains<double>& gains = plan.gains;
  for (double* gain : {&gains.velocity_1_s, &gains.tilt_1_s, &gains.yaw_1_s, &gains.roll_pitch_rate_1_s}) {
    *gain *= stiffness;
  }
  return fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(seed)), plan).flight;
}

Flight in_wind(double wind_m_s, unsigned seed, std::size_t rows) {
  ConstantWind wind;
  wind.velocity_m_s = {wind_m_s, 0, 0};
  return flown(Windy(airframe(), paper_site<double>(), StandardAtmosphere{}, wind, QuadraticDrag{}), seed, rows);
}

Flight in_gusts(double wind_m_s, unsigned seed, std::size_t rows) {
  constexpr double height_m = 35;
  ConstantWind wind;
  wind.velocity_m_s = {wind_m_s, 0, 0};
  std::mt19937_64 engine(seed);
  const DrydenTurbulence<> gusts(engine, DrydenParameters::low_altitude(wind_m_s, height_m), wind_m_s);
  return flown(Gusty(airframe(), paper_site<double>(), StandardAtmosphere{}, wind, gusts, QuadraticDrag{}), seed, rows);
}

Calm calm(double mass_share = 1) {
  return Calm(airframe(mass_share), paper_site<double>(), StandardAtmosphere{}, QuadraticDrag{});
}

/// Scores of rows, one after the other; greater is worse.
struct Scores {
  std::vector<double> errors, envelope, distance, residual, both;

  void add(const Scores& other) {
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(errors, other.errors);
    append(envelope, other.envelope);
    append(distance, other.distance);
    append(residual, other.residual);
    append(both, other.both);
  }
};

/// How far the features lie outside the envelope, in half-widths of it; 0 inside.
double excess(const Model& model, const Model::FeatureVector& x) {
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double lower = double(model.envelope_lower[i]), upper = double(model.envelope_upper[i]);
    const double beyond = std::fmax(lower - static_cast<double>(x[i]), static_cast<double>(x[i]) - upper);
    worst = std::fmax(worst, beyond / ((upper - lower) / 2));
  }
  return worst;
}

/// The command residual of a row is that of the rows before it: all that is known when the row is asked for.
Scores scored(const Model& model, const FittedTrust& trust, const Flight& flight) {
  const RowSet rows(flight, {0, flight.size()});
  const auto series = trust_series(model, trust.distribution, rows);
  const std::vector<double> means = command_residual_means(series.errors, trust.command_residual_factor);
  Scores scores;
  scores.errors = series.errors;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    scores.envelope.push_back(excess(model, sample_features<PhysicsFeatures, float>(flight[row])));
    scores.distance.push_back(series.squared_distances[row] / trust.squared_distance_limit);
    scores.residual.push_back((row == 0 ? 0.0 : means[row - 1]) / trust.command_residual_limit);
    scores.both.push_back(std::fmax(std::sqrt(scores.distance.back()), scores.residual.back()));
  }
  return scores;
}

/// Blocks of 10 s with a score above `limit`.
int alarms(const std::vector<double>& scores, double limit) {
  constexpr std::size_t block_rows = 200;
  int count = 0;
  for (const double most : block_maxima(scores, block_rows)) count += most > limit ? 1 : 0;
  return count;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::vector<bool> above(const std::vector<double>& errors, double limit) {
  std::vector<bool> result;
  for (const double error : errors) result.push_back(error > limit);
  return result;
}

/// Share of the bad rows on which a score is above 1.
double caught(const std::vector<double>& scores, const std::vector<bool>& bad) {
  double all = 0, found = 0;
  for (std::size_t row = 0; row < bad.size(); ++row) {
    all += bad[row] ? 1 : 0;
    found += bad[row] && scores[row] > 1 ? 1 : 0;
  }
  return found / all;
}

double share(const std::vector<bool>& values) {
  double count = 0;
  for (const bool value : values) count += value ? 1 : 0;
  return count / static_cast<double>(values.size());
}

}  // namespace

int main(int argc, char** argv) {
  Scale scale;
  if (argc > 1 && std::string(argv[1]) == "short") scale = {3000, 1, 1, 3};

  const Flight training = flown(calm(), 1, scale.rows);
  const auto blocks = split_contiguous(training.size());
  const RowSet train(training, blocks.train), choose(training, blocks.validation);
  const auto settings = make_context<Settings>(train);
  ResidualTraining how;
  how.epochs = scale.epochs;
  std::mt19937_64 engine(1);
  const auto fit = fit_monotone<Residual>(settings, train, choose, fit_monotone_base(settings, train), how, engine,
                                          [](int) { return true; });
  const Model model = make_trained_model(fit.predictor, settings, train);

  std::vector<Flight> validation;
  for (int i = 0; i < scale.validating; ++i)
    validation.push_back(flown(calm(), 101u + static_cast<unsigned>(i), scale.rows));
  RowSet validating;
  for (const Flight& flight : validation) validating.add(flight, {0, flight.size()});
  const auto trust = fit_trust(model, train, validating);
  std::printf("limits: squared distance %.1f, command residual %.4f, cleared %.4f\n", trust.squared_distance_limit,
              trust.command_residual_limit, trust.command_residual_cleared);

  const auto judged = [&](const auto& fly_one) {
    Scores all;
    for (int i = 0; i < scale.flights; ++i) {
      const Flight flight = fly_one(1001u + static_cast<unsigned>(i));
      if (flight.size() < scale.rows) std::printf("a flight ended after %zu rows\n", flight.size());
      all.add(scored(model, trust, flight));
    }
    return all;
  };
  const Scores quiet = judged([&](unsigned seed) { return flown(calm(), seed, scale.rows); });
  const double usual = mean_of(quiet.errors);
  const double minutes = static_cast<double>(quiet.errors.size()) * 0.05 / 60;
  std::printf(
      "unseen calm flights: %.1f min, mean error %.2fe-3; false alarms: envelope %d, distance %d, command residual %d, "
      "either of the last two %d\n",
      minutes, 1e3 * usual, alarms(quiet.envelope, 0), alarms(quiet.distance, 1), alarms(quiet.residual, 1),
      alarms(quiet.both, 1));

  std::printf(
      "\n| flights | mean error, 1e-3 | rows above 3 x the usual | AUROC: envelope | distance | residual | both | "
      "without "
      "calm rows: distance | residual | refused of these rows: distance | residual | either |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto line = [&](const char* name, const Scores& there) {
    Scores with = there;
    with.add(quiet);
    const auto bad = above(with.errors, 3 * usual), bad_there = above(there.errors, 3 * usual);
    std::printf("| %s | %.1f | %.0f %% | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.0f %% | %.0f %% | %.0f %% |\n",
                name, 1e3 * mean_of(there.errors), 100 * share(bad_there), auroc(with.envelope, bad),
                auroc(with.distance, bad), auroc(with.residual, bad), auroc(with.both, bad),
                auroc(there.distance, bad_there), auroc(there.residual, bad_there),
                100 * caught(there.distance, bad_there), 100 * caught(there.residual, bad_there),
                100 * caught(there.both, bad_there));
  };
  line("wind 3 m/s", judged([&](unsigned seed) { return in_wind(3, seed, scale.rows); }));
  line("wind 8 m/s", judged([&](unsigned seed) { return in_wind(8, seed, scale.rows); }));
  line("wind 12 m/s", judged([&](unsigned seed) { return in_wind(12, seed, scale.rows); }));
  line("gusts, 8 m/s", judged([&](unsigned seed) { return in_gusts(8, seed, scale.rows); }));
  line("gusts, 12 m/s", judged([&](unsigned seed) { return in_gusts(12, seed, scale.rows); }));
  line("payload +20 %", judged([&](unsigned seed) { return flown(calm(1.2), seed, scale.rows); }));
  line("another controller", judged([&](unsigned seed) { return flown(calm(), seed, scale.rows, 1.5); }));
}
