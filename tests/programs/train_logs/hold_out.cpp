// SPDX-License-Identifier: MIT
// Rows held out are never trained on: whole flights, repeats together, no copy under another name.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "simulated_dataset.hpp"
#include "training/hold_out.hpp"

namespace {

using Names = std::vector<std::string>;

/// A flight whose rows have content of their own, without a simulator.
pinnquad::Flight made_flight(const std::string& name, const std::string& trajectory, std::size_t rows, double first) {
  pinnquad::Flight flight;
  for (std::size_t row = 0; row < rows; ++row) {
    pinnquad::Sample sample;
    sample.time_s = 0.02 * static_cast<double>(row);
    sample.velocity_m_s[0] = first + static_cast<double>(row);
    flight.push_back(sample);
  }
  flight.name = name;
  flight.trajectory = trajectory;
  return flight;
}

/// circle twice, eight, star, and two flights that name no trajectory.
pinnquad::Dataset repeats() {
  pinnquad::Dataset dataset;
  dataset.add(made_flight("circle_1", "circle", 100, 1e3));
  dataset.add(made_flight("circle_2", "circle", 120, 2e3));
  dataset.add(made_flight("eight_1", "eight", 100, 3e3));
  dataset.add(made_flight("star_1", "star", 90, 4e3));
  dataset.add(made_flight("x", "", 100, 5e3));
  dataset.add(made_flight("y", "", 200, 6e3));
  return dataset;
}

void require_apart(const programs::Fold& fold) {
  std::set<const pinnquad::Flight*> seen;
  for (const pinnquad::RowSet* rows : {&fold.split.train, &fold.split.validation, &fold.split.test}) {
    REQUIRE_FALSE(rows->empty());
    for (const pinnquad::FlightRows& piece : rows->pieces()) {
      CHECK(seen.insert(piece.flight).second);           // in one part alone
      CHECK(piece.rows.size() == piece.flight->size());  // and whole
      for (const pinnquad::Flight* other : seen) {
        if (other->trajectory.empty() || other->trajectory != piece.flight->trajectory) continue;
        const bool here = std::any_of(rows->pieces().begin(), rows->pieces().end(),
                                      [&](const pinnquad::FlightRows& p) { return p.flight == other; });
        CHECK(here);  // repeats are on the same side
      }
    }
  }
}

bool says(const std::exception& error, const std::string& what) {
  return std::string(error.what()).find(what) != std::string::npos;
}

template <class Call>
void refused(const Call& call, const std::string& words) {
  try {
    call();
    FAIL("not refused: " << words);
  } catch (const std::invalid_argument& error) {
    CHECK_MESSAGE(says(error, words), error.what());
  }
}

}  // namespace

TEST_CASE("a flight that is held out takes the repeats of its trajectory with it") {
  const pinnquad::Dataset dataset = repeats();
  for (const char* name : {"circle_1", "circle"}) {
    const auto folds = programs::folds_of(dataset, {{name}, {}});
    REQUIRE(folds.size() == 1);
    CHECK(folds[0].held_out == Names{"circle_1", "circle_2"});
    require_apart(folds[0]);
  }
  const auto both = programs::folds_of(dataset, {{"star_1", "eight", "star"}, {}});
  CHECK(both[0].held_out == Names{"star_1", "eight_1"});
  CHECK(both[0].name == "star_1, eight, star");
  require_apart(both[0]);
}

TEST_CASE("in turn every trajectory is held out once; flight by flight its repeats do not train") {
  const pinnquad::Dataset dataset = repeats();
  const auto trajectories = programs::folds_of(dataset, {{}, programs::HoldOutEach::trajectory});
  REQUIRE(trajectories.size() == 5);
  Names all;
  for (const auto& fold : trajectories) {
    require_apart(fold);
    CHECK(fold.train.size() + fold.validation.size() + fold.held_out.size() == dataset.size());
    all.insert(all.end(), fold.held_out.begin(), fold.held_out.end());
  }
  CHECK(all == Names{"circle_1", "circle_2", "eight_1", "star_1", "x", "y"});

  const auto flights = programs::folds_of(dataset, {{}, programs::HoldOutEach::flight});
  REQUIRE(flights.size() == 6);
  for (const auto& fold : flights) {
    require_apart(fold);
    CHECK(fold.held_out.size() == 1);
  }
  for (const Names& part : {flights[0].train, flights[0].validation}) {
    CHECK(std::find(part.begin(), part.end(), "circle_2") == part.end());
  }
}

TEST_CASE(
    "validation is a trajectory of its own, of about a fifth of the rows left; of one trajectory its last fifth") {
  const pinnquad::Dataset dataset = repeats();
  const auto fold = programs::folds_of(dataset, {{"y"}, {}}).front();  // 510 rows left: 102 is a fifth
  CHECK(fold.validation == Names{"eight_1"});
  CHECK_FALSE(fold.part_validates);

  pinnquad::Dataset two;
  two.add(made_flight("a", "", 100, 0));
  two.add(made_flight("b", "", 50, 1e3));
  const auto part = programs::folds_of(two, {{"b"}, {}}).front();
  CHECK(part.part_validates);
  REQUIRE(part.split.train.pieces().size() == 1);
  CHECK(part.split.train.pieces()[0].rows.end == 80);
  CHECK(part.split.validation.pieces()[0].rows.begin == 80);
}

TEST_CASE("a name that is none is refused in one line with the nearest that are; so is nothing left to train on") {
  const pinnquad::Dataset dataset = repeats();
  refused(
      [&] {
        programs::folds_of(dataset, {{"circel_1"}, {}});
      },
      "--hold-out circel_1: no flight and no trajectory of that name; nearest: circle_1");
  refused([&] { programs::folds_of(dataset, {{"ar"}, {}}); }, "nearest: star, star_1");
  refused(
      [&] {
        programs::folds_of(dataset, {{"circle", "eight", "star", "x", "y"}, {}});
      },
      "no flight is left to train on");
}

TEST_CASE("a leak is refused: the same flight under another name, or a stretch of it on a clock of its own") {
  const pinnquad::Flight flown = pinnquad_test::simulated_flight("a", 1, 300);
  const auto dataset_with = [&](pinnquad::Flight planted) {
    pinnquad::Dataset dataset;
    dataset.add(flown);
    dataset.add(pinnquad_test::simulated_flight("b", 2, 300));
    dataset.add(pinnquad_test::simulated_flight("c", 3, 300));
    planted.name = "planted";
    dataset.add(std::move(planted));
    return dataset;
  };
  const pinnquad::Dataset copied = dataset_with(flown);
  refused([&] { programs::folds_of(copied, {{"planted"}, {}}); }, "300 of the 300 rows of the held-out flight planted");
  pinnquad::Flight stretch;
  for (std::size_t row = 200; row < 300; ++row) {
    stretch.push_back(flown[row]);
    stretch[stretch.size() - 1].time_s -= 7;
  }
  const pinnquad::Dataset cut = dataset_with(stretch);
  refused([&] { programs::folds_of(cut, {{"a"}, {}}); }, "100 of the 300 rows of the held-out flight a");
  CHECK_NOTHROW(programs::folds_of(cut, {{"b"}, {}}));  // there both train
}

namespace {

Names judges_of(const programs::Fold& fold) {
  Names names;
  for (const programs::Judge& judge : fold.judges) {
    names.push_back(judge.name);
    std::size_t rows = 0;
    for (const pinnquad::RowSet* part : {&judge.rows, &judge.others}) {
      for (const pinnquad::FlightRows& piece : part->pieces()) {
        rows += piece.rows.size();
        CHECK(std::find(fold.held_out.begin(), fold.held_out.end(), piece.flight->name) == fold.held_out.end());
      }
    }
    CHECK(rows == fold.split.train.size() + fold.split.validation.size());  // every row once
  }
  return names;
}

}  // namespace

TEST_CASE("every trajectory that is not held out chooses in turn; another vehicle never does, unless it is named") {
  const pinnquad::Dataset dataset = repeats();
  const auto fold_of = [&](const Names& validate, const Names& unlike) {
    return programs::folds_of(dataset, {{"y"}, {}, validate, unlike}).front();
  };
  CHECK(judges_of(fold_of({}, {})) == Names{"circle_1, circle_2", "star_1", "x", "eight_1"});
  CHECK(fold_of({}, {}).caution.empty());
  // eight_1 is closest to a fifth of the rows: it neither chooses nor stops networks
  const auto unlike = fold_of({}, {"eight_1", "circle_2"});
  CHECK(judges_of(unlike) == Names{"circle_1", "star_1", "x"});
  CHECK(unlike.validation != Names{"eight_1"});
  CHECK(unlike.chosen_by.find("not by circle_2, eight_1, of another vehicle") != std::string::npos);
  const auto named = fold_of({"eight"}, {"eight_1"});
  CHECK(judges_of(named) == Names{"eight_1"});
  CHECK(named.validation == Names{"eight_1"});
  CHECK(named.caution.find("another vehicle or payload than in most") == 0);
  CHECK(fold_of({"eight"}, {"circle_1"}).caution.empty());
  CHECK_FALSE(fold_of({}, {"circle_1", "circle_2", "eight_1", "star_1", "x"}).caution.empty());

  // the only one of its vehicle chooses by quarters of itself, and the others train
  const auto one = fold_of({}, {"circle_1", "circle_2", "eight_1", "star_1"});
  CHECK(judges_of(one) == Names{"x from row 0", "x from row 25", "x from row 50", "x from row 75"});
  CHECK(one.part_validates);
  CHECK(one.validation == Names{"x"});
  CHECK(one.caution.find("quarters") != std::string::npos);
  const auto repeated = fold_of({}, {"x", "eight_1", "star_1"});
  CHECK(judges_of(repeated) == Names{"circle_1", "circle_2"});
  CHECK(repeated.chosen_by.find("circle_1, circle_2, each flight left out in turn") == 0);
  CHECK(repeated.caution == "all of them fly trajectory circle; better: flights on other trajectories");

  refused([&] { fold_of({"y"}, {}); }, "--validate y: is held out");
  refused([&] { fold_of({"eigth"}, {}); }, "--validate eigth: no flight");
}

TEST_CASE("of a rotation the partings that hold another vehicle out have no say") {
  const pinnquad::Dataset dataset = repeats();
  const auto chooses = [&](const Names& validate, const Names& unlike) {
    Names list;
    for (const auto& fold : programs::folds_of(dataset, {{}, programs::HoldOutEach::trajectory, validate, unlike})) {
      if (fold.chooses) list.push_back(fold.name);
    }
    return list;
  };
  CHECK(chooses({}, {"x", "circle_2"}) == Names{"circle", "eight", "star", "y"});
  CHECK(chooses({"x"}, {"x"}) == Names{"x"});
  CHECK(chooses({}, {"circle_1", "circle_2", "eight_1", "star_1", "x", "y"}).size() == 5);
}
