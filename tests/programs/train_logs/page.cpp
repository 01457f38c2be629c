// SPDX-License-Identifier: MIT
// The report page of judged flights says what was held out, what each model is worth, and where it was wrong. The page
// stays in the working folder, to be looked at.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "judged_run.hpp"
#include "page/text.hpp"
#include "training/training_page.hpp"
#include "training/worst_moments.hpp"

namespace {

using pinnquad_test::Judged;

/// Names that a page must hold as text, and a battery that sags.
pinnquad::Dataset with_battery(const pinnquad::Dataset& flights) {
  pinnquad::Dataset dataset;
  for (pinnquad::Flight flight : flights.flights()) {
    pinnquad::ExtraColumn battery;
    battery.name = "battery_voltage";
    battery.unit = "V";
    for (std::size_t row = 0; row < flight.size(); ++row)
      battery.values.push_back(4.1 - 1e-3 * static_cast<double>(row));
    flight.add_column(battery);
    dataset.add(std::move(flight));
  }
  return dataset;
}

std::string page_of(Judged& run, const std::vector<std::string>& absent, bool with_watched) {
  pinnquad::logs::ImportedDataset imported;
  imported.flights = run.dataset;
  imported.absent = absent;
  imported.sample_period_s = 0.05;
  imported.notes = {"specific force by the library's own formula"};
  imported.steps.push_back({"saturated", 4000, 3200, "a command below 0.005 or above 0.995"});
  programs::TrainingReport report("nowhere.json", run.plan, imported);
  report.judged(run.plan, run.judged, run.verdicts);
  const auto dynamics = programs::held_out_dynamics(run.plan, run.fits, run.judged, 2, run.plan.first_seed);
  report.held_out(dynamics, run.judged);
  nlohmann::json told = report.json();
  if (with_watched) {
    told["vehicle"] = {
        {"not_identified_because", nullptr},
        {"contradicted", {"the hover command is 0.3 to 0.32 in the flights, 0.5 of it"}},
        {"numbers",
         {{"roll_effectiveness_rad_s2",
           {{"value", 39.87654}, {"low", 38.2}, {"high", 41.5}, {"unit", "rad/s^2"}, {"excitation", "good"}}},
          {"delay_s",
           {{"value", nullptr},
            {"low", nullptr},
            {"high", nullptr},
            {"unit", "s"},
            {"excitation", "not determined"},
            {"fly", "quick small rolls"}}}}}};
  }
  programs::TrainingPage input{run.plan,     imported, run.fits,       run.judged,
                               run.verdicts, told,     std::size_t{2}, "Exported as out/model.hpp.",
                               {},           &dynamics};
  for (const std::string& flight : run.judged.flights) {
    if (with_watched) input.watched[flight] = "watch-" + flight + ".html";
  }
  return programs::training_page(input);
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

/// The charts of a page, as the script that draws them reads them.
std::vector<nlohmann::json> charts_of(const std::string& page) {
  const std::string begin = "<div class=\"chart\"><script type=\"application/json\">", end = "</script>";
  std::vector<nlohmann::json> charts;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    charts.push_back(nlohmann::json::parse(page.substr(from, page.find(end, from) - from)));
    CHECK(page.substr(page.find(end, from) + end.size(), 25) == "<div class=\"wide\"><table ");
  }
  return charts;
}

const nlohmann::json& series_of(const nlohmann::json& chart, std::size_t panel, const std::string& name) {
  for (const nlohmann::json& series : chart["panels"][panel]["series"]) {
    if (series["name"] == name) return series;
  }
  FAIL("no series " << name);
  return chart;
}

}  // namespace

TEST_CASE("the page: figures, verdicts, drawings, worst moments with their links") {
  using namespace pinnquad_test;
  Judged run(with_battery(simulated_dataset(8, 300)),
             {constant_kind(), secret_mean_kind(), linear_kind(), spoiled_linear_kind(),
              oracle_kind(programs::TimeReach::centred), needs_battery_kind()},
             each_flight, 5);
  const std::string page = page_of(run, {}, true);
  std::ofstream("training_page.html") << page;
  for (const std::string& sentence :
       {run.of("linear").sentence, run.of("network").sentence, run.of("spoiled").sentence}) {
    CHECK_MESSAGE(page.find(programs::html_text(sentence)) != std::string::npos, sentence);
  }
  CHECK(page.find("looking ahead: for planned trajectories only") != std::string::npos);
  CHECK(page.find("needs battery_voltage, which the logs lack") != std::string::npos);
  CHECK(page.find("battery, V") != std::string::npos);
  CHECK(page.find("specific force by the library") != std::string::npos);
  CHECK(page.find("a command below 0.005 or above 0.995") != std::string::npos);
  CHECK(page.find("href=\"watch-flight") != std::string::npos);
  CHECK(page.find("can’t reach p") == std::string::npos);  // eight flights can
  CHECK(page.find("· speed ") != std::string::npos);
  CHECK(page.find("nan") == std::string::npos);
  CHECK(page.find("{{") == std::string::npos);
  CHECK(page.find("<th>signed sum of the commands</th>") == std::string::npos);  // none were compared
  // over time, gain and phase, residuals; flights, errors over, ellipses; four moments
  const std::vector<nlohmann::json> charts = charts_of(page);
  REQUIRE(charts.size() == 3 + 3 + 4);
  CHECK(charts[3]["panels"][0]["y"]["rows"] == nlohmann::json(run.judged.flights));
  const std::vector<double> errors = programs::error_of_flights(run.judged.kinds[2]);
  const nlohmann::json& marks = series_of(charts[3], 0, run.judged.kinds[2].kind.title);
  REQUIRE(marks["x"].size() == errors.size());
  for (std::size_t flight = 0; flight < errors.size(); ++flight) {
    CHECK(marks["x"][flight].get<double>() == doctest::Approx(1e3 * errors[flight]).epsilon(1e-6));
    CHECK(marks["y"][flight] == flight);
  }
  for (std::size_t moment = 6; moment < charts.size(); ++moment) {
    const nlohmann::json& flown = series_of(charts[moment], 0, "flown");
    const auto motor =
        static_cast<std::size_t>(charts[moment]["panels"][0]["y"]["name"].get<std::string>().back() - '1');
    std::size_t of_flights = 0;
    for (const pinnquad::Flight& flight : run.dataset.flights()) {
      std::size_t same = 0;
      for (std::size_t i = 0; i < flown["x"].size(); ++i) {
        const auto row = static_cast<std::size_t>(std::lround(flown["x"][i].get<double>() / 0.05));
        for (const std::size_t near : {row - 1, row, row + 1}) {
          if (near >= flight.size() || std::abs(flight[near].time_s - flown["x"][i].get<double>()) > 1e-4) continue;
          if (std::abs(flight[near].commands[motor] - flown["y"][i].get<double>()) < 1e-6) ++same;
        }
      }
      of_flights += same == flown["x"].size() ? 1 : 0;
    }
    CHECK_MESSAGE(of_flights == 1, "moment " << moment - 5 << " is not drawn as one flight flew it");
  }
  CHECK(page.find("<h2>Gain and phase, predicted to flown</h2>") != std::string::npos);
  CHECK(page.find(" with this noise") != std::string::npos);
  CHECK(page.find("outside the envelope of the training rows") != std::string::npos);
  CHECK(page.find("<td class=\"n\">39.9</td><td class=\"n\">38.2 to 41.5</td><td>rad/s^2</td><td>good</td>") !=
        std::string::npos);
  CHECK(page.find("– to –") != std::string::npos);
  CHECK(page.find("given: the hover command is 0.3 to 0.32") != std::string::npos);
  CHECK(count_of(page, "class=\"moment\"") == 8);
}

TEST_CASE(
    "the page of logs that lack velocity and height leaves out what it can't know, and says that one flight can't "
    "decide") {
  using namespace pinnquad_test;
  Judged run(simulated_dataset(4, 300), {constant_kind(), secret_mean_kind(), linear_kind()}, {{"flight2"}, {}}, 2);
  const std::string page = page_of(run, {"velocity", "altitude"}, false);
  CHECK(page.find("The logs have none of the three") != std::string::npos);
  CHECK(page.find("The logs lack: velocity, altitude") != std::string::npos);
  CHECK(page.find("Fewer than 6 held-out flights can’t reach p") != std::string::npos);
  CHECK(page.find("· speed ") == std::string::npos);
  CHECK(page.find("· tilt ") != std::string::npos);
  CHECK(page.find("No flights to watch in 3D") != std::string::npos);
  CHECK(page.find("id=\"vehicle\"") == std::string::npos);
}

TEST_CASE("the page begins with the verdict, the path flown with and without the model, and its Inputs to copy") {
  using namespace pinnquad_test;
  Judged run(simulated_dataset(4, 300), {constant_kind(), secret_mean_kind(), linear_kind()}, {{"flight2"}, {}}, 2);
  pinnquad::logs::ImportedDataset imported;
  imported.flights = run.dataset;
  imported.sample_period_s = 0.05;
  programs::TrainingReport report("nowhere.json", run.plan, imported);
  report.judged(run.plan, run.judged, run.verdicts);
  report.flown(
      {{"period_s", 7.5},
       {"model",
        {{"rmse_m", 0.0123}, {"answered_share", 0.75}, {"largest_error_m", 1}, {"flown_s", 30}, {"status", "ok"}}},
       {"formula", {{"rmse_m", 0.02}, {"largest_error_m", 1}, {"flown_s", 30}, {"status", "ok"}}},
       {"without_jerk", {{"rmse_m", 0.456}, {"largest_error_m", 1}, {"flown_s", 30}, {"status", "ok"}}},
       {"against_formula", nlohmann::json::object()}});
  programs::FlightVerdict found("all is well");
  found.care("R^2 0.7 is <low>", "record more");
  programs::FlownTraces traces;
  traces.model = {{0, 2}, {0.125, 1.125}, {0.25, 1.25}, {0.5, 1.5}, {0.75, 1.75}, {0, 0.125}};
  traces.without = traces.model;
  traces.without.error_m = {0, 0.25};
  programs::TrainingPage input{run.plan,
                               imported,
                               run.fits,
                               run.judged,
                               run.verdicts,
                               report.json(),
                               std::size_t{2},
                               "Exported.",
                               {},
                               nullptr,
                               &found,
                               &traces,
                               "first line\nsecond line\n"};
  const std::string page = programs::training_page(input);
  const std::size_t verdict = page.find("<div class=\"verdict care\"><h1>fly with care</h1>");
  REQUIRE(verdict != std::string::npos);
  CHECK(page.find("R² 0.7 is &lt;low&gt;.") != std::string::npos);
  CHECK(page.find("<b>Next:</b> record more") != std::string::npos);
  CHECK(page.find("Evidence: all is well.") != std::string::npos);
  CHECK(verdict < page.find("<b>1.2 cm</b>"));
  CHECK(page.find("45.6 cm without it") != std::string::npos);
  CHECK(page.find("<b>75.0&#160;%</b><span>of the path") != std::string::npos);
  CHECK(page.find("Path from above") < page.find("<details"));
  const nlohmann::json path = charts_of(page).front();
  CHECK(series_of(path, 0, "planned")["x"] == nlohmann::json({0.25, 1.25}));
  CHECK(series_of(path, 0, "planned")["y"] == nlohmann::json({0.125, 1.125}));
  CHECK(series_of(path, 0, "with the model")["x"] == nlohmann::json({0.75, 1.75}));
  CHECK(series_of(path, 0, "with the model")["y"] == nlohmann::json({0.5, 1.5}));
  CHECK(series_of(path, 1, "with the model")["x"] == nlohmann::json({0.0, 2.0}));
  CHECK(series_of(path, 1, "with the model")["y"] == nlohmann::json({0.0, 12.5}));
  CHECK(series_of(path, 1, "without the model")["y"] == nlohmann::json({0.0, 25.0}));
  CHECK(page.find("first line&#10;second line&#10;") < page.find("<details"));
  CHECK(page.find("{{") == std::string::npos);
  CHECK(page.find("<th>signed sum of the commands</th>") == std::string::npos);  // none were compared
}

TEST_CASE("the page draws what the first seed's model predicts") {
  using namespace pinnquad_test;
  const Judged run(simulated_dataset(3, 300), {secret_mean_kind()}, {{"flight2"}, {}}, 3);
  REQUIRE(run.fits.finished.size() == 3);
  pinnquad::logs::ImportedDataset imported;
  const nlohmann::json none;
  const programs::TrainingPage page{run.plan, imported, run.fits, run.judged, run.verdicts, none, {}, "", {}};
  const auto shown = programs::shown_predictions(page, 0);
  REQUIRE(shown.size() == 1);
  for (const programs::FinishedFit& fit : run.fits.finished) {
    CHECK((shown[0] == &fit.held_out) == (fit.seed == run.plan.first_seed));
  }
}

TEST_CASE("the worst moment is where a model was spoiled, and what happened there is named") {
  using namespace pinnquad_test;
  pinnquad::Flight flight = simulated_flight("a", 1, 400);
  flight[200].commands = {0.99, 0.5, 0.5, 0.01};
  pinnquad::Dataset dataset(flight);
  programs::Fold fold;
  fold.split.test.add(dataset[0], {0, 400});
  programs::Predictions made;
  for (std::size_t row = 0; row < 400; ++row) made.push_back(dataset[0][row].commands);
  for (std::size_t row = 196; row < 206; ++row) made[row][2] += 0.2;
  made[50][1] += 0.05;
  const std::vector<programs::Fold> folds = {fold};
  const auto moments = programs::worst_moments(folds, {&made}, {std::vector<bool>(400, true)}, 3);
  REQUIRE(moments.size() == 3);
  CHECK(moments[0].row >= 196);
  CHECK(moments[0].row < 206);
  CHECK(moments[0].motor == 2);
  CHECK(moments[0].error == doctest::Approx(0.1).epsilon(0.15));  // one motor of four is off by 0.2
  pinnquad::logs::ImportedDataset imported;
  imported.sample_period_s = 0.05;
  const std::string told = programs::what_happened(moments[0], imported);
  CHECK_MESSAGE(told.find("a motor at full (") == 0, told);
  CHECK_MESSAGE(told.find("a motor at idle (0.0") != std::string::npos, told);
}
