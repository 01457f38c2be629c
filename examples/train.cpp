// SPDX-License-Identifier: MIT
// `pinnquad train` from C++: flights in, a model that may fly out. It fits a structured model
// (docs/structured_models.md), judges it on rows that it has not seen, and writes header, block and limits of trust.
//   train FOLDER FLIGHT.csv...
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "pinnquad/pinnquad.hpp"

using namespace pinnquad;

int main(int count, char** arguments) try {
  if (count < 3) throw std::invalid_argument("expected FOLDER FLIGHT.csv...");
  Dataset flights;
  for (int i = 2; i < count; ++i) {
    auto flight = read_flight_csv(arguments[i]);
    flight.name = std::filesystem::path(arguments[i]).filename().string();
    require_plausible(arguments[i], flight);
    flights.add(std::move(flight));
  }
  const auto split = split_for_training(flights);  // one flight: 60 % train, 20 % validate, 20 % test, in time

  StructuredSettings settings;
  settings.residual.epochs = 20;  // a first look: the default is 300, from 5 seeds
  settings.seeds = 1;
  const auto fits = fit_structured(split, given_airframe<PaperQuadrotor>(), settings);
  const auto& best = fits.best();  // least error on the validation rows
  std::printf("seed %d, %s the altitude\n", int(best.seed), fits.altitude.taken ? "shown" : "not shown");

  const Judgement judged = judge(best.model, split);
  std::printf("test rows: R^2 %.4f, of linear regression %.4f\n", judged.verdict.test_r_squared,
              judged.verdict.linear_regression_r_squared);
  if (judged.verdict.worse_than_mean()) throw std::runtime_error("not exported: worse than the mean of the commands");

  auto from = provenance_of(flights, split, best.seed, settings.residual.epochs, structured_in_words, judged.verdict);
  from.slopes = best.slopes.of;  // said in the header's first lines, with the verdict
  from.bias_time_constants_s = chosen_bias_time_constants_s(best.model, split.validation);  // learnt in flight
  const auto exported = export_model(arguments[1], "MyModel", best.model, split, from);
  std::printf("proven: a roll slope of %.6f s^2/rad or more\n", exported.certificate->held_slope[0]);
  if (!exported.no_trust_because.empty()) std::printf("no trust.hpp: %s\n", exported.no_trust_because.c_str());
} catch (const std::exception& error) {
  std::fprintf(stderr, "train: %s\n", error.what());
  return 1;
}
