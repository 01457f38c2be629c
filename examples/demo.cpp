// SPDX-License-Identifier: MIT
// The whole chain in one file: a flight of the paper is flown and recorded; the paper's networks and a structured model
// are trained on it, judged on rows that they have not seen, and the best structured one is proven and exported.
//   demo FOLDER [SEEDS [EPOCHS [SEED]]]     scripts/demo runs it; examples/fly_model.cpp flies what it writes
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "pinnquad/data/csv.hpp"
#include "pinnquad/deploy/export_model.hpp"
#include "pinnquad/deploy/structured_model.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/evaluation/past_bias.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"

using namespace pinnquad;

/// Trainings on all cores, with progress.
class AllCores : public FitWork {
 public:
  explicit AllCores(const char* what) : what_(what) {}

  void run(std::size_t count, const std::function<bool(std::size_t)>& job) const override {
    std::atomic<std::size_t> next{0}, done{0};
    const auto work = [&] {
      for (std::size_t i = next++; i < count; i = next++) {
        job(i);
        std::fprintf(stderr, "\r  %s: %zu of %zu ", what_, ++done, count);
      }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency() && i < count; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    std::fprintf(stderr, "\r%48s\r", "");
  }

 private:
  const char* what_;
};

using PaperNetwork = Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
using Knowledge = Context<PaperFeatures, PaperQuadrotor>;

/// Mean absolute error of the commands on the test rows, one network for each seed. The seed gives initialisation and
/// order of the batches, alike for every loss.
template <class Loss>
double network_error(const char* name, const RowSplit& split, int seeds, int epochs, std::uint64_t first_seed) {
  const auto context = make_context<Knowledge>(split.train);
  const auto data = standardised<float>(context, split.train);
  std::vector<double> errors(static_cast<std::size_t>(seeds));
  AllCores(name).run(errors.size(), [&](std::size_t i) {
    std::mt19937_64 engine(first_seed + i);
    const auto network = initialised<PaperNetwork>(engine);
    const auto trainer =
        std::make_unique<Trainer<PaperNetwork, Loss, Adam, Knowledge>>(network, Loss{}, Adam{}, context);
    for (int epoch = 0; epoch < epochs; ++epoch) trainer->epoch(data, {epoch, epochs}, engine);
    const auto model = make_trained_model(trainer->network(), context, split.train);
    errors[i] = model_errors(model, split.test).mean.mean_absolute;
    return true;
  });
  double sum = 0;
  for (const double error : errors) sum += error;
  return sum / seeds;
}

/// The same of the linearized model, Eq. (3), which learns nothing.
double linearized_error(const RowSet& rows) {
  const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
  const Rotors<double> rotors(airframe);
  const Site<double> site = paper_site<double>();
  std::vector<Commands<double>> predicted, flown;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Sample& row = rows[i];
    const double density = standard_atmosphere_density_kg_m3(site.elevation_m + row.altitude_m);
    predicted.push_back(linearized_commands(
        airframe, rotors, Accelerations<double>{row.linear_acceleration_m_s2, row.angular_acceleration_rad_s2},
        site.gravity_m_s2, density / standard_air_density_kg_m3<double>));
    flown.push_back(row.commands);
  }
  return prediction_errors(predicted, flown).mean.mean_absolute;
}

int main(int count, char** arguments) try {
  const char* expected = "expected FOLDER [SEEDS [EPOCHS [SEED]]]";
  if (count < 2) throw std::invalid_argument(expected);
  const auto number = [&](int place, int usual, int least) {
    if (count <= place) return usual;
    char* end = nullptr;
    const long value = std::strtol(arguments[place], &end, 10);
    if (*end != 0 || value < least || value > 999'999'999) throw std::invalid_argument(expected);
    return static_cast<int>(value);
  };
  const std::string folder = arguments[1];
  const int seeds = number(2, 5, 1), epochs = number(3, 300, 1);
  const auto seed = static_cast<std::uint64_t>(number(4, 1, 0));
  std::filesystem::create_directories(folder);

  std::printf("Fly: ");
  const auto vehicle = flight_vehicle<AgileFlight>(airframe_value<PaperQuadrotor, double>());
  const RecordedFlight recorded = fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(seed)), AgileFlight::plan());
  if (recorded.report.end != FlightEnd::completed) throw std::runtime_error("the flight ended early; try another SEED");
  write_flight_csv(folder + "/flight.csv", recorded.flight);
  std::printf("%zu rows of %s, %s (%s/flight.csv)\n", recorded.flight.size(), AgileFlight::name, AgileFlight::summary,
              folder.c_str());

  Dataset flights;
  flights.add(recorded.flight);
  const RowSplit split = split_for_training(flights);  // one flight: 60 % train, 20 % validate, 20 % test, in time
  std::printf("Train on %zu rows, %d seeds each; judge on %zu others\n", split.train.size(), seeds, split.test.size());
  StructuredSettings settings;
  settings.residual.epochs = epochs;
  settings.seeds = seeds;
  settings.first_seed = seed;
  const auto fits = fit_structured<InverseFeatures, InverseFeatures>(split, given_airframe<PaperQuadrotor>(), settings,
                                                                     AllCores("structured"));
  const auto& best = fits.best();  // least error on the validation rows
  const Judgement judged = judge(best.model, split);
  double structured = 0;
  for (const auto& fit : fits.models) structured += judge(fit.model, split).errors.mean.mean_absolute / seeds;
  std::printf("  mean absolute error of the commands, 1e-3, 0 to 1 is full thrust\n");
  std::printf("    linearized formula           %7.2f\n", 1e3 * linearized_error(split.test));
  std::printf("    the paper's network          %7.2f\n",
              1e3 * network_error<Mse>("network", split, seeds, epochs, seed));
  std::printf("    with the paper's loss        %7.2f\n",
              1e3 * network_error<PaperLoss<CyclicalAnnealing>>("paper's loss", split, seeds, epochs, seed));
  std::printf("    structured                   %7.2f   (R^2 %.4f)\n", 1e3 * structured, judged.verdict.test_r_squared);
  if (judged.verdict.worse_than_mean()) throw std::runtime_error("not exported: worse than the mean of the commands");

  auto from = provenance_of(flights, split, best.seed, epochs, structured_in_words, judged.verdict);
  from.slopes = best.slopes.of;
  from.bias_time_constants_s = chosen_bias_time_constants_s(best.model, split.validation);  // learnt in flight
  const Exported exported = export_model(folder, "TrainedQuadModel", best.model, split, from);
  const auto& slope = exported.certificate->held_slope;
  std::printf("Export %s/model.hpp, model.block%s\n", folder.c_str(),
              exported.no_trust_because.empty() ? ", trust.hpp" : "");
  if (!exported.certificate->monotone) throw std::runtime_error("nothing is proven of the export");
  std::printf(
      "  proven for every input: more angular acceleration asked is more torque commanded, by at least\n"
      "  %.2f (roll), %.2f (pitch), %.2f (yaw) of the airframe's own slope in hover\n",
      slope[0] / judged.nominal_slopes[0], slope[1] / judged.nominal_slopes[1], slope[2] / judged.nominal_slopes[2]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "demo: %s\n", error.what());
  return 1;
}
