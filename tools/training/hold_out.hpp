// SPDX-License-Identifier: MIT
// Deals a dataset's flights to judging, validation and training: whole flights, repeats of a trajectory never on both
// sides.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "command_line/listed.hpp"
#include "logs/nearest_names.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/training/structured/closed_form.hpp"

namespace programs {

/// The groups held out in turn, where no names are given.
enum class HoldOutEach { flight, trajectory };

struct HoldOutChoice {
  std::vector<std::string> names;       ///< of flights or trajectories, held out together
  std::optional<HoldOutEach> each;      ///< rotation: each in turn
  std::vector<std::string> validate{};  ///< flights or trajectories that alone choose what is exported; empty: all do
  std::vector<std::string> unlike{};    ///< flights of another vehicle or payload: they train, and choose nothing
};

/// Rows that choose what is exported, and those that a model is fitted to that they judge.
struct Judge {
  std::string name;
  pinnquad::RowSet others, rows;
};

/// One parting of a dataset. Names are those of flights.
struct Fold {
  std::string name;  ///< of what is held out: "circle"
  std::vector<std::string> train, validation, held_out;
  /// No flight was left to validate: the last fifth of the training flights does.
  bool part_validates = false;
  bool by_time = false;       ///< one flight, in contiguous blocks: its end is held out, what is before that validates
  std::vector<Judge> judges;  ///< none of the rows held out
  std::string chosen_by;      ///< the judges in words
  std::string caution;        ///< why they are few, and what would be better; empty: they are not
  bool chooses = true;        ///< of a rotation: what is held out has a say in what is exported
  pinnquad::RowSplit split;
};

namespace detail {

/// Flights that are one piece of evidence: repeats of a trajectory, or a flight that names none.
struct FlightGroup {
  std::string name;
  std::vector<const pinnquad::Flight*> flights;
  std::size_t rows = 0;
};

inline std::vector<FlightGroup> flight_groups(const pinnquad::Dataset& dataset) {
  std::vector<FlightGroup> groups;
  for (const pinnquad::Flight& flight : dataset.flights()) {
    const std::string& name = flight.trajectory.empty() ? flight.name : flight.trajectory;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const FlightGroup& g) {
      return g.name == name && !flight.trajectory.empty() && !g.flights.front()->trajectory.empty();
    });
    if (group == groups.end()) group = groups.insert(groups.end(), FlightGroup{name, {}, 0});
    group->flights.push_back(&flight);
    group->rows += flight.size();
  }
  return groups;
}

inline void add_whole(pinnquad::RowSet& rows, std::vector<std::string>& names, const pinnquad::Flight& flight) {
  rows.add(flight, {0, flight.size()});
  names.push_back(flight.name);
}

inline bool is_among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

inline bool is_named(const FlightGroup& group, const std::vector<std::string>& names) {
  return is_among(group.name, names) ||
         std::any_of(group.flights.begin(), group.flights.end(),
                     [&](const pinnquad::Flight* flight) { return is_among(flight->name, names); });
}

/// Has a flight of the vehicle and payload of most flights.
inline bool is_alike(const FlightGroup& group, const HoldOutChoice& choice) {
  return std::any_of(group.flights.begin(), group.flights.end(),
                     [&](const pinnquad::Flight* flight) { return !is_among(flight->name, choice.unlike); });
}

/// `tested` judge; groups of `left` train, but for one, which validates: of those that may choose the one whose rows
/// come closest to a fifth of them.
inline Fold fold_of(std::string name, const std::vector<const pinnquad::Flight*>& tested,
                    const std::vector<const FlightGroup*>& left, const HoldOutChoice& choice) {
  constexpr double validation_share = 0.2;
  Fold fold;
  fold.name = std::move(name);
  for (const pinnquad::Flight* flight : tested) add_whole(fold.split.test, fold.held_out, *flight);
  if (left.empty()) {
    throw std::invalid_argument("--hold-out " + pinnquad::printable(fold.name) +
                                ": no flight is left to train on; expected two flights or more of different "
                                "trajectories");
  }
  std::vector<const FlightGroup*> may;
  const auto let = [&](const auto& which) {
    if (may.empty()) std::copy_if(left.begin(), left.end(), std::back_inserter(may), which);
  };
  let([&](const FlightGroup* group) { return is_named(*group, choice.validate); });
  const bool named = !may.empty() && may.size() < left.size();
  let([&](const FlightGroup* group) { return is_alike(*group, choice); });
  let([](const FlightGroup*) { return true; });
  fold.part_validates = may.size() == 1 && !named;
  double rows = 0;
  for (const FlightGroup* group : left) rows += static_cast<double>(group->rows);
  const auto miss = [&](const FlightGroup* group) {
    return std::abs(static_cast<double>(group->rows) - validation_share * rows);
  };
  const FlightGroup* validates = *std::min_element(
      may.begin(), may.end(), [&](const FlightGroup* a, const FlightGroup* b) { return miss(a) < miss(b); });
  for (const FlightGroup* group : left) {
    const bool of_validation = named ? std::find(may.begin(), may.end(), group) != may.end() : group == validates;
    for (const pinnquad::Flight* flight : group->flights) {
      if (!of_validation) {
        add_whole(fold.split.train, fold.train, *flight);
      } else if (!fold.part_validates) {
        add_whole(fold.split.validation, fold.validation, *flight);
      } else {
        const auto border = static_cast<std::size_t>((1 - validation_share) * static_cast<double>(flight->size()));
        fold.split.train.add(*flight, {0, border});
        fold.split.validation.add(*flight, {border, flight->size()});
        fold.train.push_back(flight->name);
        fold.validation.push_back(flight->name);
      }
    }
  }
  return fold;
}

/// Gives a parting its judges: each trajectory that is not held out is left out in turn, of one trajectory each flight,
/// of one flight each quarter. Flights of another vehicle or payload are none of them, unless they are named.
inline void let_choose(Fold& fold, const HoldOutChoice& choice) {
  std::vector<pinnquad::FlightRows> left;  // of each flight what is not held out
  for (const pinnquad::RowSet* part : {&fold.split.train, &fold.split.validation}) {
    for (const pinnquad::FlightRows& piece : part->pieces()) {
      const auto known =
          std::find_if(left.begin(), left.end(), [&](const auto& of) { return of.flight == piece.flight; });
      if (known == left.end()) {
        left.push_back(piece);
      } else {
        known->rows = {std::min(known->rows.begin, piece.rows.begin), std::max(known->rows.end, piece.rows.end)};
      }
    }
  }
  pinnquad::RowSet alike, others;
  bool named = false, unlike = false;
  const auto deal = [&](const auto& may_choose) {
    alike = others = {};
    for (const pinnquad::FlightRows& of : left) (may_choose(*of.flight) ? alike : others).add(*of.flight, of.rows);
  };
  deal([&](const pinnquad::Flight& flight) {
    return is_among(flight.name, choice.validate) || is_among(flight.trajectory, choice.validate);
  });
  named = !alike.empty() && !others.empty();
  if (!named) deal([&](const pinnquad::Flight& flight) { return !is_among(flight.name, choice.unlike); });
  if (alike.empty()) {
    deal([](const pinnquad::Flight&) { return true; });
    unlike = true;
  }
  const auto names = [](const pinnquad::RowSet& rows) {
    std::vector<std::string> list;
    for (const pinnquad::FlightRows& piece : rows.pieces()) list.push_back(pinnquad::printable(piece.flight->name));
    return listed(list);
  };
  const bool whole = pinnquad::whole_flight_groups(alike).size() > 1;
  const std::string path = alike.empty() ? "" : alike.pieces().front().flight->trajectory;
  const bool one_path = whole && !path.empty() &&
                        std::all_of(alike.pieces().begin(), alike.pieces().end(),
                                    [&](const auto& piece) { return piece.flight->trajectory == path; });
  for (const pinnquad::RowSet& group :
       named ? std::vector<pinnquad::RowSet>{alike} : pinnquad::left_out_groups(alike)) {
    Judge judge{names(group), others, group};
    const pinnquad::FlightRows& first = group.pieces().front();
    if (!named && !whole) judge.name += " from row " + std::to_string(first.rows.begin);
    for (const pinnquad::FlightRows& piece : alike.pieces()) {
      const auto out = std::find_if(group.pieces().begin(), group.pieces().end(),
                                    [&](const auto& of) { return of.flight == piece.flight; });
      if (out == group.pieces().end()) {
        judge.others.add(*piece.flight, piece.rows);
      } else {
        judge.others.add(*piece.flight, {piece.rows.begin, out->rows.begin});
        judge.others.add(*piece.flight, {out->rows.end, piece.rows.end});
      }
    }
    fold.judges.push_back(std::move(judge));
  }
  fold.chosen_by = named   ? names(alike) + ", as --validate says"
                   : whole ? names(alike) + (one_path ? ", each flight" : ", each trajectory") + " left out in turn"
                           : names(alike) + ", each quarter of it left out in turn";
  if (named) {
    const auto is_unlike = [&](const auto& piece) { return is_among(piece.flight->name, choice.unlike); };
    if (std::any_of(alike.pieces().begin(), alike.pieces().end(), is_unlike) &&
        !std::all_of(others.pieces().begin(), others.pieces().end(), is_unlike)) {
      fold.caution =
          "another vehicle or payload than in most flights chooses between models fitted to them; better: a flight "
          "like those that train, or flights of this vehicle alone";
    }
    return;
  }
  if (!others.empty()) fold.chosen_by += "; not by " + names(others) + ", of another vehicle or payload";
  if (unlike) {
    fold.caution =
        "none of the flights that choose has the vehicle and payload of most flights; better: fly one that has, "
        "or name the judge with --validate";
  } else if (!whole) {
    fold.caution =
        "one flight chooses by quarters of itself, which are alike; better: another flight of this vehicle, "
        "on another trajectory";
  } else if (one_path) {
    fold.caution =
        "all of them fly trajectory " + pinnquad::printable(path) + "; better: flights on other trajectories";
  }
}

/// Hashes of a row's content but its time, which another cut of the same log may count from elsewhere.
inline std::vector<std::uint64_t> row_hashes(const pinnquad::RowSet& rows) {
  std::vector<std::uint64_t> hashes;
  hashes.reserve(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    pinnquad::detail::Fnv1a fnv;
    const pinnquad::Sample::Values values = pinnquad::to_values(rows[row]);
    for (std::size_t i = 1; i < values.size(); ++i) pinnquad::detail::absorb_number(fnv, values[i]);
    hashes.push_back(fnv.hash);
  }
  return hashes;
}

}  // namespace detail

/// Throws std::invalid_argument, one line, where rows that judge are, to the bit, among those that train or validate.
inline void require_no_leak(const Fold& fold) {
  constexpr double most_shared = 0.01;  // of a vehicle at rest some rows may be alike
  std::vector<std::uint64_t> known = detail::row_hashes(fold.split.train);
  const std::vector<std::uint64_t> validating = detail::row_hashes(fold.split.validation);
  known.insert(known.end(), validating.begin(), validating.end());
  std::sort(known.begin(), known.end());
  for (const pinnquad::FlightRows& piece : fold.split.test.pieces()) {
    std::size_t shared = 0;
    for (const std::uint64_t hash : detail::row_hashes(pinnquad::RowSet(*piece.flight, piece.rows))) {
      if (std::binary_search(known.begin(), known.end(), hash)) ++shared;
    }
    if (static_cast<double>(shared) <= most_shared * static_cast<double>(piece.rows.size())) continue;
    throw std::invalid_argument(std::to_string(shared) + " of the " + std::to_string(piece.rows.size()) +
                                " rows of the held-out flight " + pinnquad::printable(piece.flight->name) +
                                " are among those that train: it would be judged on what it was trained on");
  }
}

/// The partings that a choice asks for; views of the dataset. A flight that is held out takes the repeats of its
/// trajectory with it. Throws std::invalid_argument, one line: a name that is no flight and no trajectory (with the
/// nearest that are), too few flights, a flight that comes twice.
inline std::vector<Fold> folds_of(const pinnquad::Dataset& dataset, const HoldOutChoice& choice) {
  const std::vector<detail::FlightGroup> groups = detail::flight_groups(dataset);
  const auto others = [&](const auto& is_out) {
    std::vector<const detail::FlightGroup*> left;
    for (const detail::FlightGroup& group : groups) {
      if (!is_out(group)) left.push_back(&group);
    }
    return left;
  };
  const auto group_of = [&](const std::string& option, const std::string& name) {
    const auto group = std::find_if(groups.begin(), groups.end(),
                                    [&](const detail::FlightGroup& g) { return detail::is_named(g, {name}); });
    if (group != groups.end()) return &*group;
    std::vector<std::string> known;
    for (const detail::FlightGroup& g : groups) {
      known.push_back(g.name);
      for (const pinnquad::Flight* flight : g.flights) known.push_back(flight->name);
    }
    throw std::invalid_argument(option + " " + pinnquad::printable(name) +
                                ": no flight and no trajectory of that name; " +
                                pinnquad::logs::nearest_names(name, known));
  };
  for (const std::string& name : choice.validate) group_of("--validate", name);
  const auto may_choose = [&](const std::string& name, const std::vector<const pinnquad::Flight*>& flights) {
    const detail::FlightGroup group{name, flights, 0};
    return choice.validate.empty() ? detail::is_alike(group, choice) : detail::is_named(group, choice.validate);
  };
  std::vector<Fold> folds;
  if (choice.each) {
    for (const detail::FlightGroup& group : groups) {
      const auto left = others([&](const detail::FlightGroup& other) { return &other == &group; });
      if (*choice.each == HoldOutEach::trajectory) {
        folds.push_back(detail::fold_of(group.name, group.flights, left, choice));
        folds.back().chooses = may_choose(group.name, group.flights);
        continue;
      }
      for (const pinnquad::Flight* flight : group.flights) {  // its repeats neither train nor judge
        folds.push_back(detail::fold_of(flight->name, {flight}, left, choice));
        folds.back().chooses = may_choose(group.name, {flight});
      }
    }
  } else {
    std::vector<const detail::FlightGroup*> out;
    std::string all;
    for (const std::string& name : choice.names) {
      const detail::FlightGroup* group = group_of("--hold-out", name);
      if (std::find(out.begin(), out.end(), group) == out.end()) out.push_back(group);
      add_to_list(all, name);
    }
    for (const std::string& name : choice.validate) {
      if (std::find(out.begin(), out.end(), group_of("--validate", name)) == out.end()) continue;
      throw std::invalid_argument("--validate " + pinnquad::printable(name) +
                                  ": is held out, and what is held out has no say; expected another flight");
    }
    std::vector<const pinnquad::Flight*> tested;
    for (const detail::FlightGroup* group : out) {
      tested.insert(tested.end(), group->flights.begin(), group->flights.end());
    }
    folds.push_back(detail::fold_of(all, tested, others([&](const detail::FlightGroup& g) {
                                      return std::find(out.begin(), out.end(), &g) != out.end();
                                    }),
                                    choice));
    detail::let_choose(folds.back(), choice);
  }
  if (std::none_of(folds.begin(), folds.end(), [](const Fold& fold) { return fold.chooses; })) {
    for (Fold& fold : folds) fold.chooses = true;
  }
  for (const Fold& fold : folds) require_no_leak(fold);
  return folds;
}
std::vector<Fold> folds_of(const pinnquad::Dataset&&, const HoldOutChoice&) = delete;  // its rows would be gone

/// The parting of flights of which none is named to be held out, in their order: of one its last part, of three or more
/// the last. Throws what split_for_training() throws.
inline Fold fold_in_order(const pinnquad::Dataset& dataset) {
  Fold fold;
  fold.split = pinnquad::split_for_training(dataset);
  fold.by_time = dataset.size() == 1;
  const auto names = [](const pinnquad::RowSet& rows) {
    std::vector<std::string> of;
    for (const pinnquad::FlightRows& piece : rows.pieces()) of.push_back(piece.flight->name);
    return of;
  };
  fold.train = names(fold.split.train);
  fold.validation = names(fold.split.validation);
  fold.held_out = names(fold.split.test);
  fold.name = listed(fold.held_out);
  detail::let_choose(fold, {});
  return fold;
}
Fold fold_in_order(const pinnquad::Dataset&&) = delete;  // its rows would be gone

/// Rows of the model exported after a rotation: all flights, the group closest to a fifth validates.
inline Fold fold_of_all(const pinnquad::Dataset& dataset, const HoldOutChoice& choice) {
  const std::vector<detail::FlightGroup> groups = detail::flight_groups(dataset);
  std::vector<const detail::FlightGroup*> all;
  for (const detail::FlightGroup& group : groups) all.push_back(&group);
  return detail::fold_of("all flights", {}, all, choice);
}

}  // namespace programs
