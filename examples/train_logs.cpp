// SPDX-License-Identifier: MIT
// Trains on logs with an input that `pinnquad train` does not know: an [[extra]] column of their mapping, found by name
// and unit. Whole flights are held out, the last one judges.
//   train_logs FOLDER DATASET        what `pinnquad import` wrote
//   train_logs FOLDER LOGS MAPPING   imports first
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "pack_temperature.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "pinnquad/pinnquad.hpp"

using namespace pinnquad;

using Vehicle = PaperQuadrotor;                                    // what flew
using MyFeatures = WithColumns<InverseFeatures, PackTemperature>;  // logs without velocity: ...WithoutVelocity

int main(int count, char** arguments) try {
  if (count < 3) throw std::invalid_argument("expected FOLDER and DATASET, or FOLDER, LOGS and MAPPING");
  logs::LogSettings how;
  how.mapping = count > 3 ? arguments[3] : "";
  how.airframe = Vehicle::name;
  const logs::ImportedDataset imported = logs::read_source({arguments[2]}, how);
  const RowSplit split = split_by_flight(imported.flights);

  StructuredSettings settings;
  settings.residual.epochs = 60;
  settings.seeds = 1;
  // second set: the same with the altitude, where that is an input
  const auto fits = fit_structured<MyFeatures, MyFeatures>(split, given_airframe<Vehicle>(), settings);
  const auto& best = fits.best();

  const Judgement judged = judge(best.model, split);
  std::printf("flights held out: R^2 %.4f\n", judged.verdict.test_r_squared);
  if (judged.verdict.worse_than_mean()) throw std::runtime_error("not exported: worse than the mean of the commands");

  Provenance from =
      provenance_of(imported.flights, split, best.seed, settings.residual.epochs, structured_in_words, judged.verdict);
  from.lag_removed_s = imported.lag_removed_s;
  from.slopes = best.slopes.of;
  const Exported exported = export_model(arguments[1], "MyModel", best.model, split, from);
  std::printf("proven: a roll slope of %.6f s^2/rad or more\n", exported.certificate->held_slope[0]);
} catch (const std::exception& error) {  // one line: a flight without the column is named
  std::fprintf(stderr, "train_logs: %s\n", error.what());
  return 1;
}
