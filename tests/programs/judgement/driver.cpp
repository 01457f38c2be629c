// SPDX-License-Identifier: MIT
// Networks whose figures are not finite: they are never the best, and the comparison goes on without them.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "support/temporary_folder.hpp"
#include "training/export_choice.hpp"
#include "training/judgement.hpp"
#include "training/training_report.hpp"

namespace {

const double nan_error = std::numeric_limits<double>::quiet_NaN();
const double infinite_error = std::numeric_limits<double>::infinity();

programs::Result result(const std::string& model, std::uint64_t seed, double error) {
  programs::Result made{model, seed, {}, error, 0};
  made.test.errors.mean = {error, error, 1 - error};
  return made;
}

}  // namespace

TEST_CASE("the best network has a finite error, wherever the others stand") {
  using programs::best_of;
  std::vector<programs::Result> results = {result("a", 1, nan_error), result("a", 2, 0.3), result("b", 1, 0.1),
                                           result("a", 3, 0.2), result("a", 4, infinite_error)};
  CHECK(best_of(results, "a") == 3);
  CHECK(best_of(results, "b") == 2);
  CHECK_FALSE(best_of(results, "c").has_value());
  CHECK_FALSE(best_of({result("a", 1, nan_error), result("a", 2, -infinite_error)}, "a").has_value());
}

TEST_CASE("figures that are undefined are left out of the paired comparison") {
  // an axis that stands still: no angle, no slope
  std::vector<programs::Result> results;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    results.push_back(result("candidate", seed, seed == 2 ? nan_error : 0.1));
    results.push_back(result("baseline", seed, 0.2));
    for (auto* made : {&results.back(), &results[results.size() - 2]}) {
      made->test.axes[2].angle_difference_deg = nan_error;
      made->test.axes[2].slope_error = infinite_error;
    }
  }
  CHECK_NOTHROW(programs::print_paired(results, "candidate", "baseline"));
  CHECK_NOTHROW(programs::print_table(results, {"candidate", "baseline"}));
}

TEST_CASE("a report is JSON whatever the figures are: what is not finite is null") {
  const pinnquad_test::TemporaryFolder folder;
  programs::write_report(folder.path("report.json"), {{"flight", "x"}}, {result("a", 1, nan_error)},
                         {{"r2", nan_error}});
  std::ifstream file(folder.path("report.json"));
  const nlohmann::json report = nlohmann::json::parse(file);
  CHECK(report["results"][0]["mae"].is_null());
  CHECK(report["verdict"]["r2"].is_null());
  CHECK(report["settings"]["flight"] == "x");
}

TEST_CASE("the structured model is exported, the best by the validation rows, and no network in its place") {
  using programs::LossName;
  const LossName &vanilla = programs::vanilla, &informed = programs::physics_informed, &own = programs::structured;
  const std::vector<LossName> losses = {vanilla, informed, own};
  // R^2 is 1 less the error here
  std::vector<programs::Result> results = {result("linearized", 0, 0.5), result(vanilla.title, 1, 0.1),
                                           result(informed.title, 1, 0.2), result(own.title, 1, 0.3),
                                           result(own.title, 2, 0.4)};
  const auto exported = [&] { return programs::chosen_export(losses, results, 0.5); };
  CHECK(exported().best == 3);
  CHECK(exported().name() == "best structured model");
  results[3].validation_error = 0.5;  // what the test rows say does not choose
  CHECK(exported().best == 4);

  results.pop_back();
  results[3] = result(own.title, 1, 1.5);
  CHECK(exported().best == 3);
  CHECK(exported().verdict.worse_than_mean());

  results[3] = result(own.title, 1, nan_error);
  CHECK_FALSE(exported().best.has_value());
  CHECK(programs::reason_of_none(exported().loss, results) ==
        "no structured model predicts finite commands on the validation rows");

  results.pop_back();  // interrupted before it
  CHECK_FALSE(exported().best.has_value());
  CHECK(exported().loss.key == own.key);
  CHECK(programs::reason_of_none(exported().loss, results) == "no structured model was finished");
}

TEST_CASE("without a structured model the physics-informed network is exported, or the first that was asked for") {
  using programs::loss_names;
  CHECK(programs::exported_kind({loss_names[0], loss_names[1]}).key == programs::physics_informed.key);
  CHECK(programs::exported_kind({loss_names[2], loss_names[3]}).key == loss_names[2].key);
  CHECK(programs::exported_kind({programs::structured}).key == programs::structured.key);
  CHECK(programs::exported_network({loss_names[0], loss_names[1], programs::structured}).key == loss_names[1].key);
  const std::vector<programs::LossName> all = {loss_names[0], loss_names[1], programs::structured};
  CHECK(programs::compared_with(all, programs::structured) == &programs::physics_informed);
  CHECK(programs::compared_with({loss_names[0], programs::structured}, programs::structured) == &programs::vanilla);
  CHECK(programs::compared_with(all, loss_names[1]) == &programs::vanilla);
  CHECK(programs::compared_with(all, loss_names[0]) == nullptr);
}
