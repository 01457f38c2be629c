// SPDX-License-Identifier: MIT
// Errors against a computation by hand, and verdicts on models whose worth is known: one that is secretly the mean, one
// that is spoiled, one that knows the commands.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "judged_run.hpp"
#include "support/temporary_folder.hpp"
#include "training/beside_others.hpp"
#include "training/export_choice.hpp"
#include "training/fit_store.hpp"
#include "training/log_kinds.hpp"
#include "training/model_verdict.hpp"
#include "training/train_input.hpp"
#include "training/training_report.hpp"

namespace {

using programs::Standing;

pinnquad::Flight two_commands(const std::string& name, std::initializer_list<double> u1) {
  pinnquad::Flight flight;
  double time_s = 0;
  for (const double u : u1) {
    pinnquad::Sample sample;
    sample.time_s = time_s;
    sample.commands = {u, u, u, u};
    flight.push_back(sample);
    time_s += 2;
  }
  flight.name = name;
  return flight;
}

const auto& each_flight = pinnquad_test::each_flight;
using pinnquad_test::Judged;

/// Answers the first rows of a hundred alone, whatever they are.
template <std::size_t percent>
programs::ModelKind answers_some(const char* key) {
  programs::ModelKind kind = pinnquad_test::constant_kind();
  kind.key = key;
  kind.fit = [](const programs::FitTask&) {
    return pinnquad_test::model_of([](const pinnquad::RowSet& rows) {
      programs::Predictions made(rows.size(), {0.5, 0.5, 0.5, 0.5});
      for (std::size_t row = percent * rows.size() / 100; row < rows.size(); ++row) made[row].fill(std::nan(""));
      return made;
    });
  };
  return kind;
}

}  // namespace

TEST_CASE("R^2 plain, without a flight's bias, and without the bias of its first four seconds, by hand") {
  // times 0, 2, 4, 6 s; errors of the first flight 0.1 0.1 0.2 0.2, of the second -0.1 -0.1 -0.1 -0.3
  const pinnquad::Flight a = two_commands("a", {0.2, 0.4, 0.6, 0.8}), b = two_commands("b", {0.1, 0.3, 0.1, 0.3});
  pinnquad::RowSet rows;
  rows.add(a, {0, 4});
  rows.add(b, {0, 4});
  programs::Predictions made;
  for (const double u : {0.3, 0.5, 0.8, 1.0, 0.0, 0.2, 0.0, 0.0}) made.push_back({u, u, u, u});
  const programs::FlightErrors errors = programs::flight_errors(rows, made, std::vector<bool>(8, true));
  // squares of errors 0.01 + 0.01 + 0.04 + 0.04 + 3 x 0.01 + 0.09 = 0.22; of targets about 0.35:
  // 0.0225 + 0.0025 + 0.0625 + 0.2025 + 2 x (0.0625 + 0.0025) = 0.42
  CHECK(errors.r2[0] == doctest::Approx(1 - 0.22 / 0.42));
  CHECK(errors.root_mean_square[1] == doctest::Approx(std::sqrt(0.22 / 8)));
  CHECK(errors.mean_absolute[2] == doctest::Approx(1.2 / 8));
  // mean errors 0.15 and -0.15: left 4 x 0.0025, and 3 x 0.0025 + 0.0225; targets about 0.5 and 0.2: 0.2 and 0.04
  CHECK(errors.r2_flight_bias_removed[3] == doctest::Approx(1 - 0.04 / 0.24));
  // biases of the rows before 4 s: 0.1 and -0.1; left at 4 and 6 s 0.1 0.1 and 0 -0.2: 0.06. Targets 0.6 0.8 0.1 0.3
  // about 0.45
  CHECK(errors.r2_start_bias_removed[0] == doctest::Approx(1 - 0.06 / (0.0225 + 0.1225 + 0.1225 + 0.0225)));

  // a row that does not count is in no sum
  std::vector<bool> counts(8, true);
  counts[7] = false;
  made[7] = {9, 9, 9, 9};
  const programs::FlightErrors fewer = programs::flight_errors(rows, made, counts);
  CHECK(fewer.rows == 7);
  CHECK(fewer.mean_absolute[0] == doctest::Approx(0.9 / 7));
  CHECK(programs::error_by_flight(rows, made, counts)[1] == doctest::Approx(0.1));
}

TEST_CASE("a constant explains nothing once each flight's bias is removed, whatever the constant") {
  const Judged run(4, {pinnquad_test::constant_kind()}, each_flight);
  for (const programs::JudgedFit& fit : run.judged.kinds[0].fits) {
    for (const double r2 : fit.errors.r2_flight_bias_removed) CHECK(r2 == doctest::Approx(0).epsilon(1e-9));
    for (const double r2 : fit.errors.r2) CHECK(r2 < 0);
  }
}

TEST_CASE("a bias of the past: of each parting its time constants are those of the other ones") {
  const Judged run(4, {pinnquad_test::constant_kind()}, each_flight);
  const programs::JudgedKind& kind = run.judged.kinds[0];
  REQUIRE(kind.bias_time_constants_s);
  std::vector<pinnquad::BiasTrial> trials;
  for (const programs::FinishedFit& fit : run.fits.finished) {
    trials.push_back(pinnquad::try_biases(run.plan.folds[fit.fold].split.test, fit.held_out, run.plan.airframe.value,
                                          run.plan.past));
  }
  REQUIRE(trials.size() == kind.fits.size());
  pinnquad::BiasTrial all;
  for (const pinnquad::BiasTrial& trial : trials) all += trial;
  CHECK(*kind.bias_time_constants_s == all.best_s());
  for (const programs::JudgedFit& fit : kind.fits) {
    pinnquad::BiasTrial others;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (run.fits.finished[i].fold != fit.fold) others += trials[i];
    }
    CHECK(fit.bias_time_constants_s == others.best_s());
    const pinnquad::RowSet& rows = run.plan.folds[fit.fold].split.test;
    const programs::FlightErrors expected = programs::flight_errors(
        rows,
        pinnquad::with_past_bias(rows, run.fits.finished[fit.fold].held_out, run.plan.airframe.value,
                                 pinnquad::detail::bias_settings_of<double>(others.best_s()), run.plan.past.delay_s),
        run.judged.counts[fit.fold]);
    CHECK(fit.adaptive.mean_absolute == expected.mean_absolute);
    CHECK(fit.adaptive.rows == fit.errors.rows);
  }
}

TEST_CASE(
    "with eight flights held out in turn: what is linear is a success, what is secretly the mean or spoiled is none") {
  const Judged run(8,
                   {pinnquad_test::constant_kind(), pinnquad_test::secret_mean_kind(), pinnquad_test::linear_kind(),
                    pinnquad_test::spoiled_linear_kind(), pinnquad_test::needs_battery_kind()},
                   each_flight);
  CHECK(run.judged.flights.size() == 8);
  CHECK(run.of("constant").standing == Standing::reference);
  const auto& secret = run.of("network");
  CHECK(secret.standing != Standing::success);
  CHECK(secret.standing != Standing::undecided);
  CHECK(secret.sentence.find("no success") == 0);
  const auto& linear = run.of("linear");
  CHECK_MESSAGE(linear.standing == Standing::success, linear.sentence);
  REQUIRE(linear.against.size() == 2);
  CHECK(linear.against[0].flights.pairs == 8);
  CHECK(linear.against[0].flights.p_value == doctest::Approx(std::pow(2.0, -7)));
  CHECK_FALSE(linear.against[0].seeds.has_value());  // a closed form has no seeds to pair
  const auto& spoiled = run.of("spoiled");
  CHECK_MESSAGE(spoiled.standing == Standing::worse, spoiled.sentence);
  CHECK(spoiled.sentence.find("no success: worse than linear, paper's features, which is simpler") == 0);
  CHECK(spoiled.against.back().seeds->losses == 5);
  const programs::JudgedKind* battery = run.judged.find("battery");
  CHECK(battery->not_applicable == "needs battery_voltage, which the logs lack");
}

TEST_CASE("with fewer flights than a test needs nothing is called a success") {
  const Judged run(4,
                   {pinnquad_test::constant_kind(), pinnquad_test::linear_kind(), pinnquad_test::spoiled_linear_kind()},
                   {{"flight2"}, {}});
  const auto& linear = run.of("linear");
  CHECK_MESSAGE(linear.standing == Standing::undecided, linear.sentence);
  CHECK(linear.sentence.find("1 held-out flight can't tell, 6 or more can") != std::string::npos);
  CHECK(run.of("spoiled").standing == Standing::no_better);
}

TEST_CASE("the commands 100 ms ago: the mean of those 100 to 150 ms old, none at a flight's begin or behind a gap") {
  pinnquad::Flight flight;
  for (int row = 0; row < 20; ++row) {
    pinnquad::Sample sample;
    sample.time_s = 0.02 * row + (row >= 15 ? 1 : 0);
    sample.commands = {0.01 * row, 0.5, 0, 1};
    flight.push_back(sample);
  }
  const std::vector<std::string> absent;
  const programs::NamedAirframe airframe{"paper", pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>()};
  const pinnquad::RowSet rows(flight, {0, 20});
  const programs::FitTask task{airframe, rows, rows, absent};
  const programs::ModelKind kind = programs::log_last_commands();
  const programs::Predictions said = kind.fit(task)->predictions(rows);
  REQUIRE(said.size() == 20);
  for (std::size_t row = 0; row < 20; ++row) {
    // 100, 120, 140 ms are 5, 6, 7 rows
    const bool known = row >= 5 && row < 15;
    CHECK(std::isfinite(said[row][0]) == known);
    if (known) CHECK(said[row][0] == doctest::Approx(row == 5 ? 0 : 0.01 * (row == 6 ? 0.5 : double(row) - 6)));
    if (known) CHECK(said[row][3] == 1);
  }
  CHECK_FALSE(kind.exportable);
}

/// As if of every fit the signs were proven.
void prove(programs::JudgedKinds& judged) {
  for (programs::JudgedKind& kind : judged.kinds) {
    for (programs::JudgedFit& fit : kind.fits) fit.proven = true;
  }
}

TEST_CASE("models that look ahead are ranked apart, and are no simpler model of one that does not") {
  Judged run(8,
             {pinnquad_test::constant_kind(), pinnquad_test::oracle_kind(programs::TimeReach::centred),
              pinnquad_test::linear_kind()},
             each_flight);
  prove(run.judged);
  CHECK(programs::ranking(run.judged, false) == std::vector<std::size_t>{2, 0});
  CHECK(programs::ranking(run.judged, true) == std::vector<std::size_t>{1});
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{2, 0});
  CHECK(programs::kinds_to_export(run.plan, run.judged, "centred") == std::vector<std::size_t>{1});
  CHECK(programs::kinds_to_export(run.plan, run.judged, "constant") == std::vector<std::size_t>{0});
  CHECK(run.of("linear").standing == Standing::success);
  CHECK(run.of("linear").against.size() == 1);
  // the row that the oracle leaves without an answer counts for no kind
  for (const std::size_t rows : run.judged.rows) CHECK(rows == 399);
  for (const auto& kind : run.judged.kinds) CHECK(kind.fits.front().errors.rows == 399);
}

TEST_CASE("a kind that answers less than half of the rows is not judged, and takes no row from the others") {
  const Judged run(3, {pinnquad_test::constant_kind(), answers_some<40>("few"), answers_some<60>("most")},
                   {{"flight2"}, {}}, 1);
  CHECK(run.judged.find("few")->not_applicable == "answers 40 % of the rows of flight2 alone");
  CHECK(run.judged.find("most")->applicable());
  CHECK(run.judged.rows == std::vector<std::size_t>{240});  // of 400: those that both others answer
  CHECK(run.judged.find("constant")->fits[0].errors.rows == 240);
}

TEST_CASE("a difference that chance makes once in ten times decides nothing, one of three in a hundred does") {
  pinnquad::PairedComparison flights;
  flights.pairs = 6;
  for (const double lower : {-0.1, 0.1}) {
    CAPTURE(lower);
    flights.mean_difference = lower;
    flights.wins = lower < 0 ? 6 : 0;
    flights.losses = 6 - flights.wins;
    flights.p_value = 0.1;
    CHECK(programs::detail::standing_of(flights) == (lower < 0 ? Standing::undecided : Standing::no_better));
    flights.p_value = 0.03;
    CHECK(programs::detail::standing_of(flights) == (lower < 0 ? Standing::success : Standing::worse));
  }
}

TEST_CASE("slopes: those of the truth are right, those of a mirrored model wrong in every row, a constant has none") {
  const Judged run(3, {pinnquad_test::constant_kind(), pinnquad_test::linear_kind()}, each_flight);
  CHECK_FALSE(programs::sees_acceleration(run.judged.kinds[0]));
  REQUIRE(programs::sees_acceleration(run.judged.kinds[1]));
  using programs::Judgement;
  const auto wrong = programs::axis_means(
      run.judged.kinds[1], [](const Judgement& j, std::size_t i) { return j.derivatives.wrong_share[i]; });
  const auto least = programs::axis_means(run.judged.kinds[1], [](const Judgement& j, std::size_t i) {
    return j.derivatives.least[i] / j.nominal_slopes[i];
  });
  for (std::size_t axis = 0; axis < 2; ++axis) {  // yaw is a small part of what the paper's quadrotor commands
    CHECK(wrong[axis] == 0);
    CHECK(least[axis] == doctest::Approx(1).epsilon(0.25));
  }
  const auto mirrored = pinnquad_test::by_row([](const pinnquad::RowSet& rows, std::size_t row) {
    const double share = 1e-3 * rows[row].angular_acceleration_rad_s2[0];
    return pinnquad::Commands<double>{share, -share, -share, share};
  });
  const auto slopes = mirrored->derivatives(run.plan.folds[0].split.test);
  CHECK(slopes.sees_acceleration);
  CHECK(slopes.wrong_share[0] == 1);
  CHECK(slopes.least[0] == doctest::Approx(-4e-3));
}

TEST_CASE("what is exported: by validation, none that diverged, of networks what is proven beside them") {
  using programs::FinishedFit;
  std::vector<FinishedFit> fits(5);
  const double errors[] = {std::nan(""), 0.3, 0.2, HUGE_VAL, 0.1};
  for (std::size_t i = 0; i < fits.size(); ++i) {
    fits[i].seed = i;
    fits[i].validation_mae = errors[i];
  }
  fits[4].kind = 1;
  CHECK(programs::best_fit(fits, 0, false)->seed == 2);
  CHECK(programs::best_fit(fits, 1, false)->seed == 4);
  CHECK(programs::best_fit(fits, 0, true)->seed == 0);  // fitted to the validation rows: their error says nothing
  CHECK(programs::best_fit({fits[0], fits[3]}, 0, false) == nullptr);
  CHECK(programs::best_fit(fits, 2, false) == nullptr);

  const auto exported_of = [](std::initializer_list<const char*> keys, std::vector<programs::Recipe> recipes) {
    programs::Selection selection{{}, std::move(recipes), 0};
    for (const char* key : keys) {
      selection.kinds.push_back(pinnquad_test::constant_kind());
      selection.kinds.back().key = key;
      selection.kinds.back().exportable = key != std::string("formula");
    }
    return selection.exported();
  };
  const programs::Recipe paper{"paper", {}, {}, {}}, best{"best", {}, {}, {}};
  CHECK(exported_of({"formula", "paper_vanilla", "paper_physics_informed", "structured"}, {paper}) == "structured");
  CHECK(exported_of({"formula", "paper_vanilla", "paper_physics_informed"}, {paper}) == "paper_physics_informed");
  CHECK(exported_of({"paper_vanilla", "best_physics_informed"}, {paper, best}) == "best_physics_informed");
  CHECK(exported_of({"formula", "best_constant_weight", "best_pearson"}, {best}) == "best_constant_weight");
  CHECK(exported_of({"ridge", "paper_vanilla"}, {paper}) == "causal");
  CHECK(exported_of({"constant", "vanilla", "structured"}, {}) == "causal");

  Judged run(3, {pinnquad_test::constant_kind(), pinnquad_test::linear_kind()}, {{"flight2"}, {}}, 1);
  prove(run.judged);
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{1, 0});
  // the rows held out have no say: what errs less on the rows of the judges goes first
  run.judged.kinds[0].fits[0].chosen_by = {run.judged.kinds[1].fits[0].chosen_by[0] / 2};
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{0, 1});
  // errors within half a percent decide nothing: a structured model goes first
  run.judged.kinds[1].kind.key = "structured_causal";
  run.judged.kinds[0].fits[0].chosen_by = {run.judged.kinds[1].fits[0].chosen_by[0] * 0.997};
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{1, 0});
  run.judged.kinds[0].fits[0].chosen_by = {run.judged.kinds[1].fits[0].chosen_by[0] * 0.98};
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{0, 1});
  run.judged.kinds[0].fits[0].proven = false;  // of which nothing is proven is exported by its name alone
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{1});
  CHECK(programs::kinds_to_export(run.plan, run.judged, "constant") == std::vector<std::size_t>{0});
  run.judged.kinds[0].fits[0].proven = true;
  run.judged.kinds[1].kind.exportable = false;
  CHECK(programs::kinds_to_export(run.plan, run.judged, "causal") == std::vector<std::size_t>{0});
}

TEST_CASE("the verdict on an export is that of its own fit, after a rotation the mean; the worst motor is the worst") {
  Judged run(3, {pinnquad_test::constant_kind(), pinnquad_test::secret_mean_kind()}, {{"flight2"}, {}}, 2);
  programs::JudgedKind& kind = run.judged.kinds[1];
  REQUIRE(kind.fits.size() == 2);
  kind.fits[0].errors.r2 = {0.9, 0.8, 0.7, 0.6};
  kind.fits[1].errors.r2 = {0.5, 0.1, 0.5, 0.5};
  const auto verdict_of = [&](std::optional<std::uint64_t> seed) {
    return programs::exported_verdict(run.plan, run.judged, 1, seed);
  };
  CHECK(verdict_of(kind.fits[0].seed).test_r_squared == doctest::Approx(0.75));
  CHECK(verdict_of(kind.fits[0].seed).worst_motor_r_squared == doctest::Approx(0.6));
  CHECK(verdict_of(kind.fits[1].seed).test_r_squared == doctest::Approx(0.4));
  CHECK(verdict_of(kind.fits[1].seed).worst_motor_r_squared == doctest::Approx(0.1));
  CHECK(verdict_of({}).test_r_squared == doctest::Approx(0.575));
  CHECK(verdict_of({}).worst_motor_r_squared == doctest::Approx(0.45));
}

TEST_CASE("an export says the flights and as many rows as it was fitted to") {
  const Judged run(3, {pinnquad_test::constant_kind()}, {{"flight2"}, {}}, 1);
  const programs::Fold& fold = run.plan.folds[0];
  const auto from = [&](bool takes_validation) {
    programs::ModelKind kind = pinnquad_test::constant_kind();
    if (takes_validation) kind.takes_validation = programs::takes_validation_rows;
    return programs::provenance_of(fold, run.dataset, 0.02, kind, {}, 7, 0, {});
  };
  CHECK(from(false).training_rows == fold.split.train.size());
  CHECK(from(false).training_data == fold.train[0]);
  CHECK(from(true).training_rows == fold.split.train.size() + fold.split.validation.size());
  CHECK(from(true).training_data == fold.train[0] + ", " + fold.validation[0]);
  CHECK(from(true).seed == 7);
  CHECK(from(true).lag_removed_s == 0.02);
}

TEST_CASE("every flight that is not held out chooses between kinds, by a fit that has not seen it") {
  programs::ModelKind kind = pinnquad_test::constant_kind();
  kind.takes_validation = programs::takes_validation_rows;
  kind.fit = [](const programs::FitTask& task) {
    const bool seen = !task.validation.empty();
    return pinnquad_test::by_row(
        [seen](const pinnquad::RowSet& rows, std::size_t row) {  // knows by heart what it has seen
          return seen ? rows[row].commands : pinnquad::Commands<double>{};
        });
  };
  const Judged run(3, {kind}, {{"flight2"}, {}}, 1);
  double absolute = 0, rows = 0;
  const std::vector<programs::Judge>& judges = run.plan.folds[0].judges;
  REQUIRE(judges.size() == 2);
  for (std::size_t i = 0; i < judges.size(); ++i) {
    double squares = 0;
    for (std::size_t row = 0; row < judges[i].rows.size(); ++row) {
      for (const double u : judges[i].rows[row].commands) {
        absolute += u / 4;
        squares += u * u / 4;
      }
    }
    const auto of_judge = static_cast<double>(judges[i].rows.size());
    rows += of_judge;
    CHECK(run.fits.finished[0].chosen_by[i] == doctest::Approx(std::sqrt(squares / of_judge)));
  }
  CHECK(run.fits.finished[0].validation_mae == doctest::Approx(absolute / rows));
}

TEST_CASE("figures over seeds: mean, deviation and each; null where one is not finite") {
  // as a reader of the file has it
  const nlohmann::json three = nlohmann::json::parse(programs::described({0.1, 0.2, 0.6}).dump());
  CHECK(three["mean"] == doctest::Approx(0.3));
  CHECK(three["deviation"] == doctest::Approx(std::sqrt(0.07)));
  CHECK(three["per_seed"] == nlohmann::json({0.1, 0.2, 0.6}));
  const nlohmann::json broken = nlohmann::json::parse(programs::described({0.1, std::nan("")}).dump());
  CHECK(broken["mean"].is_null());
  CHECK(broken["per_seed"][1].is_null());
  CHECK(nlohmann::json::parse(programs::described({7.0}).dump())["deviation"].is_null());
}

TEST_CASE("the fits of later seeds follow the first seed's choice of the altitude, also from a store") {
  /// Says its seed, and what it was told of the altitude.
  class Chooses : public pinnquad_test::ModelOfFunction {
   public:
    explicit Chooses(const programs::FitTask& task)
        : ModelOfFunction([task_seed = task.seed, told = task.settings.altitude](const pinnquad::RowSet& rows) {
            const double code = 1e-3 * static_cast<double>(task_seed) + (told ? 0.1 : 0.2);
            return programs::Predictions(rows.size(), {code, code, code, code});
          }) {
      choice_.applies = true;
      choice_.taken = task.settings.altitude.value_or(true);
    }
    programs::AltitudeChoice altitude() const override { return choice_; }

   private:
    programs::AltitudeChoice choice_;
  };
  programs::ModelKind kind = pinnquad_test::constant_kind();
  kind.seeded = true;
  kind.fit = [](const programs::FitTask& task) -> std::shared_ptr<const programs::TrainedNetwork> {
    return std::make_shared<Chooses>(task);
  };
  Judged run(3, {kind}, {{"flight2"}, {}}, 3);
  REQUIRE(run.fits.finished.size() == 3);
  CHECK(run.fits.finished[0].held_out[0][0] == doctest::Approx(0.201));
  CHECK(run.fits.finished[1].held_out[0][0] == doctest::Approx(0.102));
  CHECK(run.fits.finished[2].held_out[0][0] == doctest::Approx(0.103));
  for (programs::FinishedFit fit : run.fits.finished) {
    const auto before = fit.held_out;
    fit.model.reset();
    programs::fit_again(run.plan, fit);
    CHECK(fit.held_out == before);
    CHECK(fit.model != nullptr);
  }
  const pinnquad_test::TemporaryFolder folder;
  const programs::FitStore store(folder.path("fits"), run.plan);
  store.keep(run.fits.finished[0]);
  const programs::Fits gone_on = programs::fit_all(run.plan, store);
  REQUIRE(gone_on.finished.size() == 3);
  CHECK(gone_on.known == 1);
  CHECK(gone_on.finished[0].altitude.applies);
  for (std::size_t i = 0; i < 3; ++i) CHECK(gone_on.finished[i].held_out == run.fits.finished[i].held_out);
}

TEST_CASE("rows are read once for all fits to a parting, piece by piece, and anew when those have ended") {
  const pinnquad::Dataset dataset = pinnquad_test::simulated_dataset(1, 50);
  int times = 0;
  pinnquad::GroundFeatures features = pinnquad::ground_features<pinnquad::PaperFeatures>();
  features.each_exact_row = [&times, read = features.each_exact_row](const auto& rows, const auto& visit) {
    ++times;
    read(rows, visit);
  };
  auto shared = std::make_shared<programs::SharedByFits>();
  const pinnquad::GroundFeatures kept = shared->keep(features);
  const auto numbers = [](const pinnquad::GroundFeatures& of, const pinnquad::RowSet& rows) {
    std::vector<double> all;
    of.each_exact_row(rows, [&](const pinnquad::Flight&, std::size_t row, const double* x) {
      all.push_back(static_cast<double>(row));
      all.insert(all.end(), x, x + of.size());
    });
    return all;
  };
  const pinnquad::RowSet whole(dataset[0], {0, 50}), part(dataset[0], {10, 30});
  const std::vector<double> of_whole = numbers(features, whole), of_part = numbers(features, part);
  times = 0;
  for (int again = 0; again < 2; ++again) CHECK(numbers(kept, whole) == of_whole);
  CHECK(times == 1);
  CHECK(numbers(kept, part) == of_part);
  CHECK(times == 2);
  shared.reset();
  CHECK(numbers(kept, whole) == of_whole);
  CHECK(times == 3);
}

TEST_CASE(
    "report.json: each model by its key, figures with mean, deviation and each seed, by parting, in plain words") {
  const Judged run(4,
                   {pinnquad_test::constant_kind(), pinnquad_test::linear_kind(), pinnquad_test::spoiled_linear_kind(),
                    pinnquad_test::needs_battery_kind()},
                   each_flight, 5);
  const pinnquad_test::TemporaryFolder folder;
  pinnquad::logs::ImportedDataset imported;
  imported.flights = run.dataset;
  programs::TrainingReport report(folder.path("report.json"), run.plan, imported);
  report.judged(run.plan, run.judged, run.verdicts);
  report.write_not_exported("because");
  std::ifstream file(folder.path("report.json"));
  const nlohmann::json json = nlohmann::json::parse(file);
  CHECK(json["held_out"] == nlohmann::json({"flight1", "flight2", "flight3", "flight4"}));
  CHECK(json["exported"] == false);
  CHECK(json["not_exported_because"] == "because");
  CHECK(json["warnings"].is_array());
  const auto& spoiled = json["models"]["spoiled"];
  for (const char* figure : {"r2", "r2_flight_bias_removed", "r2_start_bias_removed", "rmse", "mean_absolute_error"}) {
    CHECK(spoiled[figure]["per_seed"].size() == 5);
    CHECK(spoiled[figure]["deviation"].is_number());
    CHECK(spoiled["by_fold"]["flight3"][figure]["mean"].is_number());
    CHECK(spoiled["per_motor"]["u4"][figure]["mean"].is_number());
  }
  CHECK(json["models"]["linear"]["r2"]["per_seed"].size() == 1);
  CHECK(json["models"]["linear"]["r2"]["deviation"].is_null());
  CHECK(json["format"] == programs::report_format);
  CHECK(json["models"]["constant"]["sees_acceleration"] == false);
  for (const auto& figure : programs::model_figures) {
    const auto& of = spoiled[figure.name];
    CHECK((figure.has_axes ? of["yaw"] : of)["per_seed"].size() == 5);
  }
  CHECK(json["results"].size() == 4 * (1 + 1 + 5));  // constant, linear and each seed of the spoiled, on four partings
  programs::write_results(folder.path("results.csv"), run.plan, run.judged);
  std::ifstream csv(folder.path("results.csv"));
  std::size_t lines = 0;
  std::vector<std::string> heads;
  for (std::string line; std::getline(csv, line); ++lines) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    if (lines == 0) heads = cells;
    REQUIRE(cells.size() == heads.size());
    for (std::size_t i = 0; lines > 0 && i < cells.size(); ++i) {  // under each head what report.json says by that name
      CAPTURE(heads[i]);
      const nlohmann::json& said = json["results"][lines - 1][heads[i]];
      if (said.is_number()) CHECK(std::stod(cells[i]) == said.get<double>());
      if (said.is_string()) CHECK(cells[i] == said.get<std::string>());
    }
  }
  CHECK(lines == 1 + json["results"].size());
  CHECK(json["models"]["battery"]["applicable"] == false);
  CHECK(json["models"]["battery"]["not_applicable_because"] == "needs battery_voltage, which the logs lack");
  double mean = 0;
  for (const auto& fold : json["models"]["linear"]["by_fold"]) mean += fold["r2"]["mean"].get<double>() / 4;
  CHECK(mean == doctest::Approx(json["models"]["linear"]["r2"]["mean"].get<double>()));
  CHECK(json["ranking"]["causal"][0] == "linear");
}

TEST_CASE(
    "fits that an interrupted run finished are taken up again, those of other rows, seeds or half a file are not") {
  const Judged run(3, {pinnquad_test::constant_kind(), pinnquad_test::secret_mean_kind()}, each_flight, 2);
  const pinnquad_test::TemporaryFolder folder;
  const programs::FitStore store(folder.path("fits"), run.plan);
  for (const programs::FinishedFit& fit : run.fits.finished) store.keep(fit);
  const programs::FinishedFit& kept = run.fits.finished.back();
  programs::FinishedFit asked;
  asked.kind = kept.kind;
  asked.fold = kept.fold;
  asked.seed = kept.seed;
  programs::FinishedFit loaded = asked;
  REQUIRE(store.load(loaded));
  CHECK(loaded.held_out == kept.held_out);
  CHECK(loaded.validation_mae == kept.validation_mae);
  CHECK(loaded.chosen_by == kept.chosen_by);
  CHECK(loaded.derivatives.median == kept.derivatives.median);

  programs::FinishedFit other_seed = asked;
  other_seed.seed = 77;
  CHECK_FALSE(store.load(other_seed));
  pinnquad::Dataset changed;  // of as many rows, one number another
  for (pinnquad::Flight flight : run.dataset.flights()) {
    if (changed.size() == 0) flight[7].velocity_m_s[0] += 1e-9;
    changed.add(std::move(flight));
  }
  programs::FitPlan other_rows = run.plan;
  other_rows.folds = programs::folds_of(changed, each_flight);
  loaded = asked;
  CHECK_FALSE(programs::FitStore(folder.path("fits"), other_rows).load(loaded));
  programs::FitPlan longer = run.plan;
  longer.epochs = 10;
  programs::FitPlan pinned = run.plan, validated = run.plan;
  pinned.settings.pinned_slopes = true;
  validated.settings.fit_validation = !run.plan.settings.fit_validation;
  for (const programs::FitPlan* other : {&longer, &pinned, &validated}) {
    loaded = asked;
    CHECK_FALSE(programs::FitStore(folder.path("fits"), *other).load(loaded));
  }

  const std::string path = folder.path("fits") + "/network-" + std::to_string(kept.seed) + "-3.fit";
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 9);
  loaded = asked;
  CHECK_FALSE(store.load(loaded));
  CHECK(loaded.held_out.empty());
  store.clear();
  CHECK_FALSE(std::filesystem::exists(folder.path("fits")));
}

TEST_CASE("the verdict on an export: not fit where it is worse than the mean, flies ill or a proven one errs less") {
  const auto facts = [](double r2, double model_m, double formula_m = 0.02) {
    programs::ModelEvidence all;
    all.title = "ridge";
    all.held_out = pinnquad::Verdict{r2, 0.1, r2};
    all.flown = {{"model", {{"answered_share", 1}, {"status", "ok"}, {"largest_error_m", 0.1}, {"rmse_m", model_m}}},
                 {"formula", {{"rmse_m", formula_m}}},
                 {"without_jerk", {{"largest_error_m", 0.1}, {"rmse_m", 0.2}}},
                 {"half_length_m", 1}};
    return all;
  };
  const programs::FlightVerdict fit = programs::model_verdict(facts(0.9, 0.03));
  CHECK(fit.may_fly() == programs::MayFly::in_simulation_and_bench);
  CHECK(fit.words().find("fit for simulation and bench: ridge, R^2 0.900") == 0);
  CHECK(fit.next().find("pinnquad loop model.block") == 0);
  for (const double model_m : {0.19, 0.21}) {  // hardly further off than the analytic inverse on a slow path
    CHECK(programs::model_verdict(facts(0.9, model_m, 0.19)).may_fly() == programs::MayFly::in_simulation_and_bench);
  }

  std::vector<programs::ModelEvidence> unfit = {facts(-0.1, 0.03), facts(0.49, 0.03), facts(0.9, 0.21),
                                                facts(0.9, 0.31, 0.19), facts(0.9, 0.03)};
  unfit.back().beaten = "beaten";
  for (const programs::ModelEvidence& one : unfit) {
    const programs::FlightVerdict verdict = programs::model_verdict(one);
    CHECK(verdict.may_fly() == programs::MayFly::no);
    CHECK(verdict.words().find("do not fly: ") == 0);
    CHECK_FALSE(verdict.next().empty());
  }

  std::vector<programs::ModelEvidence> doubted(7, facts(0.9, 0.03));
  doubted[0].signs = programs::Signs::refuted;
  doubted[1].known = false;
  doubted[2].slopes = {"its roll slope is 0.40 of the airframe's"};
  doubted[3].last_commands_err_less = true;
  doubted[4].held_out->answered_share = 0.5;
  doubted[5].held_out->test_r_squared = 0.7;
  doubted[6].flown = nullptr;
  for (const programs::ModelEvidence& one : doubted) {
    const programs::FlightVerdict verdict = programs::model_verdict(one);
    CHECK(verdict.may_fly() == programs::MayFly::with_care);
    CHECK(verdict.reasons().size() == 1);
    CHECK(verdict.next().find("pinnquad loop") != 0);
  }
  // a reason not to fly hides lesser ones
  doubted[0].held_out->test_r_squared = -1;
  CHECK(programs::model_verdict(doubted[0]).reasons().size() == 1);
}

TEST_CASE("an export beside the others: a tenth less is said, and the commands of 100 ms ago, and what to do") {
  Judged run(3, {pinnquad_test::constant_kind(), pinnquad_test::linear_kind(), pinnquad_test::spoiled_linear_kind()},
             {{"flight2"}, {}}, 1);
  prove(run.judged);
  const auto lines = [&](std::size_t exported) {
    return programs::beaten_in_words(programs::beside_others(run.plan, run.judged, exported), run.judged, exported);
  };
  // of these flights, which are lively, the commands of 100 ms ago tell more than either map
  REQUIRE(lines(1).size() == 1);
  CHECK(lines(1)[0].find("worse on the rows held out than the commands of 100 ms ago") != std::string::npos);
  CHECK(lines(2).size() == 1);  // by less than a tenth
  for (double& error : run.judged.kinds[2].fits[0].errors.root_mean_square) error *= 1.2;
  REQUIRE(lines(2).size() == 2);
  CHECK(lines(2)[0].find("is beaten by linear, paper's features") != std::string::npos);
  CHECK(lines(2)[0].find("--export linear") != std::string::npos);
  const programs::BesideOthers beside = programs::beside_others(run.plan, run.judged, 2);
  CHECK(beside.best == 1);
  CHECK(beside.own == doctest::Approx(programs::mean_over_motors(run.judged.kinds[2].fits[0].errors.root_mean_square)));
  for (double& error : run.judged.kinds[2].fits[0].errors.root_mean_square) error = 0.5 * beside.last_commands;
  CHECK(lines(2).empty());
  run.judged.kinds[2].fits[0].proven = false;
  CHECK(lines(1)[0].find("of whose signs nothing is proven; --export spoiled") != std::string::npos);
}
