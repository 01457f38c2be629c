// SPDX-License-Identifier: MIT
// Table 2 of the paper as types: a row is a model, its columns are what the study composes.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "pinnquad/data/split.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "report/paper.hpp"

namespace study {

// Structure
struct Linearized {
  static constexpr const char* name = "linearized";
};
struct Vanilla {
  static constexpr const char* name = "vanilla";
};
struct Informed {
  static constexpr const char* name = "physics-informed";
};

// Batch norm
struct Without {
  static constexpr bool batch_norm = false;
};
struct With {
  static constexpr bool batch_norm = true;
};

// Hyperparameter: the weight lambda of the physics terms
struct NoTerms {
  static constexpr const char* name = "none";
};
struct ConstantLambda {
  static constexpr const char* name = "constant";
};
struct CyclicLambda {
  static constexpr const char* name = "cyclical annealing";
};

/// Data set: which flight, which features, which share of the rows trains, validates and tests, in contiguous blocks.
/// `chooses_weights`: its validation rows may choose between the weights of a training's epochs.
template <class FlightType, class FeatureSet>
struct WholeFlight {
  static constexpr bool chooses_weights = true;
  using Flight = FlightType;
  using Features = FeatureSet;
  static constexpr pinnquad::Split<double> shares = pinnquad::usual_shares;
};
struct D1 : WholeFlight<pinnquad::AgileFlight, pinnquad::PaperFeatures> {
  static constexpr const char* name = "D1";
};
struct D2 : WholeFlight<pinnquad::NearGroundFlight, pinnquad::PaperFeaturesWithAltitude> {
  static constexpr const char* name = "D2";
};
struct D3 : WholeFlight<pinnquad::WindyFlight, pinnquad::PaperFeatures> {
  static constexpr const char* name = "D3";
};
/// docs/paper.md, deviation 16, Fig. 7: the first 20 % of D1 train, the last 40 % test; what lies between is judged as
/// validation, and chooses nothing.
struct D1Test40 : D1 {
  static constexpr const char* name = "D1, 20 % / 40 %";
  static constexpr bool chooses_weights = false;
  static constexpr pinnquad::Split<double> shares{0.2, 0.4, 0.4};
};
/// The first 20 % of D1 train, all others test; nothing is left to validate with.
struct D1Test80 : D1 {
  static constexpr const char* name = "D1, 20 % / 80 %";
  static constexpr bool chooses_weights = false;
  static constexpr pinnquad::Split<double> shares{0.2, 0.0, 0.8};
};

namespace detail {

/// The type that stands for an enumerator: as far down the list as its value.
template <auto Enumerator, class... Types>
using TypeOf = std::tuple_element_t<static_cast<std::size_t>(Enumerator), std::tuple<Types...>>;

}  // namespace detail

/// A row of Table 2 (report/paper.hpp), counted from 0. `more_flights`: part of the main comparison, which is repeated
/// on further flights.
template <std::size_t Row>
struct Model {
  static constexpr programs::PaperModel entry = programs::table2[Row];
  static constexpr int id = entry.id;
  using Structure = detail::TypeOf<entry.structure, Linearized, Vanilla, Informed>;
  using BatchNorm = std::conditional_t<entry.batch_norm, With, Without>;
  using Lambda = detail::TypeOf<entry.term, NoTerms, ConstantLambda, CyclicLambda>;
  using DataSet = detail::TypeOf<entry.data, D1, D1Test40, D1Test80, D2, D3>;
  static constexpr bool more_flights = id >= 2 && id <= 4;
};

template <class Function, std::size_t... Rows>
void each_model(const Function& function, std::index_sequence<Rows...> /*rows*/) {
  (function(Model<Rows>{}), ...);
}

/// Calls `function(Model<...>{})` for each row of Table 2, top to bottom.
template <class Function>
void each_model(const Function& function) {
  each_model(function, std::make_index_sequence<programs::table2.size()>());
}

}  // namespace study
