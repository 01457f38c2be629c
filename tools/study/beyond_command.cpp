// SPDX-License-Identifier: MIT
// Ideas beyond the paper, each beside the paper's network on the same rows.
//   pinnquad-study beyond --seeds 10 --out DIR
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

#include "airframe/choice.hpp"
#include "command_line/command.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/options.hpp"
#include "study/beyond_conditions.hpp"
#include "study/beyond_models.hpp"
#include "study/beyond_rows.hpp"
#include "study/campaign.hpp"
#include "training/training_flights.hpp"

namespace {

struct BeyondOptions {
  std::string out, mapping, airframe = study::Airframe::name;
  std::vector<std::string> conditions, models, flights;
  int seeds = 10, epochs = study::paper_epochs, flight_count = 3;
  std::uint64_t flight_seed = study::first_flight_seed;
  unsigned threads = 0;
};

/// One model under one condition, as the campaign takes it.
study::Contender contender_of(const study::BeyondModel& model, const study::Condition& condition, bool flown_here) {
  study::Contender result;
  result.id = model.name;
  result.flight = condition.name;
  result.trained = model.trained;
  result.more_flights = flown_here;
  result.training_rows = 1;
  result.description = {{"id", model.name},
                        {"flight", condition.name},
                        {"model", model.summary},
                        {"condition", condition.summary},
                        {"airframe", condition.airframe.airframe_name()}};
  result.flights = [condition](std::uint64_t seed) {
    std::vector<programs::StudyFlight> ids;
    for (const std::string& name : condition.flights) ids.push_back({name, seed});
    return ids;
  };
  result.run = [model, condition](study::Workshop& workshop, const study::Assignment& assignment,
                                  study::Outcome& outcome) {
    std::vector<const pinnquad::Flight*> flights;
    for (const std::string& name : condition.flights) {
      flights.push_back(&workshop.flights().at({name, assignment.flight_seed}));
    }
    const pinnquad::RowSplit split = condition.split(flights);
    const auto start = std::chrono::steady_clock::now();
    const study::BeyondTraining done = model.train(
        {split, condition.airframe, assignment.seed, assignment.epochs, [&workshop] { return !workshop.stopped(); }});
    if (!done.model) throw programs::Interrupted{};
    outcome.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.test = programs::judge(condition.airframe, split.test, done.model->predictions(split.test));
    outcome.test.derivatives = done.model->derivatives(split.test);
    outcome.validation_mae =
        programs::judge(condition.airframe, split.validation, done.model->predictions(split.validation))
            .errors.mean.mean_absolute;
    outcome.best_weights = done.best_weights;
    outcome.residual_kept = done.residual_kept;
    const std::optional<pinnquad::Certificate> certificate = done.model->certificate();
    outcome.proven = certificate && certificate->proven();
    if (condition.in_loop) {
      outcome.loop = study::closed_loop(
          [&done](const pinnquad::RowSet& rows) { return done.model->guarded_predictions(rows); }, *condition.in_loop);
    }
    workshop.count(assignment.epochs);
  };
  return result;
}

/// A wrong airframe is told to those who ask; the yardstick stands beside them.
bool takes_part(const study::BeyondModel& model, const study::Condition& condition) {
  return condition.told == study::Told::the_truth || model.asks_airframe || model.name == study::yardstick;
}

std::string condition_name(const std::string& flight, const std::set<std::string>& taken) {
  std::string name = pinnquad::printable(std::filesystem::path(flight).stem().string());
  for (char& c : name) {
    if (c == ',' || c == '"') c = '_';
  }
  while (name.empty() || taken.count(name) > 0) name += "_";
  return name;
}

int run(const BeyondOptions& options) {
  if (options.out.empty()) throw std::invalid_argument("--out DIR is needed");
  std::vector<study::Condition> conditions = study::chosen_conditions(study::flown_conditions(), options.conditions);
  if (options.conditions.empty() && !options.flights.empty()) conditions.clear();
  const std::size_t flown_here = conditions.size();
  const std::vector<study::BeyondModel> models = study::chosen_models(study::beyond_models(), options.models);
  const auto given = std::make_shared<std::map<std::string, pinnquad::Flight>>();
  if (!options.flights.empty()) {
    const programs::NamedAirframe airframe = programs::chosen_airframe(options.airframe);
    std::set<std::string> taken;
    for (const study::Condition& condition : study::flown_conditions()) taken.insert(condition.name);
    constexpr std::size_t least_rows = 100;
    for (const std::string& path : options.flights) {
      const pinnquad::Dataset recorded = programs::read_flights({path}, options.mapping, least_rows);
      for (const pinnquad::Flight& flight : recorded.flights()) {
        const std::string name = condition_name(flight.name, taken);
        taken.insert(name);
        (*given)[name] = flight;
        conditions.push_back(study::given_condition(name, {airframe.name, airframe.value}));
      }
    }
  }
  study::Plan plan;
  plan.kind = "beyond";
  plan.seeds = options.seeds;
  plan.epochs = options.epochs;
  plan.flights = options.flight_count;
  plan.flight_seed = options.flight_seed;
  plan.best_weights = true;
  plan.format = {study::beyond_header(), study::beyond_row};
  plan.fly = [given](const programs::StudyFlight& id) {
    const auto found = given->find(id.name);
    return found == given->end() ? study::fly_for_beyond(id) : found->second;
  };
  plan.facts = {{"network", "see models"}};
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    for (const study::BeyondModel& model : models) {
      if (takes_part(model, conditions[i])) {
        plan.contenders.push_back(contender_of(model, conditions[i], i < flown_here));
      }
    }
  }
  study::Campaign campaign(plan, options.out,
                           options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency()));
  campaign.run();
  std::printf("its report  pinnquad-study-report %s\n", options.out.c_str());
  return 0;
}

}  // namespace

namespace programs {

Command beyond_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("beyond",
                             "What goes beyond the paper: structured models beside its network, condition by "
                             "condition, as rows of DIR/rows.csv");
  const auto options = std::make_shared<BeyondOptions>();
  add_path(*line, "--out", options->out, "DIR", "folder of rows.csv and study.json");
  line->add_option("--conditions", options->conditions, "some of the conditions (default: all; with FLIGHTS none)")
      ->delimiter(',');
  line->add_option("--models", options->models, "some of the models beside the paper's network (default: all)")
      ->delimiter(',');
  add_sources(*line, options->flights, options->mapping, "recorded");
  line->add_option("--airframe", options->airframe, "what flew the recorded flights: a name or a TOML file")
      ->capture_default_str();
  add_number(*line, "--seeds", options->seeds, 1, 100, "trainings of each model, from seeds 1, 2, ...");
  add_number(*line, "--flights", options->flight_count, 1, 1000, "flights of each condition that is flown");
  add_number(*line, "--epochs", options->epochs, 1, 100000, "epochs of each training");
  add_number(*line, "--flight-seed", options->flight_seed, std::uint64_t{0}, most_seed, "seed of the first flights")
      ->type_name("N");
  add_number(*line, "--threads", options->threads, 1u, 1024u, "trainings at once (default: all cores)")
      ->default_str("");
  line->footer(study::exit_codes);
  return {line, [options] { return run(*options); }};
}

}  // namespace programs
