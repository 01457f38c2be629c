// SPDX-License-Identifier: MIT
// Table 2 of the paper as types: a row is a model, its columns are what the study composes.
#pragma once

#include <tuple>

#include "pinnquad/data/split.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/simulation/flights.hpp"

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
  static constexpr pinnquad::detail::Split<double> shares = pinnquad::usual_shares;
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
  static constexpr pinnquad::detail::Split<double> shares{0.2, 0.4, 0.4};
};
/// The first 20 % of D1 train, all others test; nothing is left to validate with.
struct D1Test80 : D1 {
  static constexpr const char* name = "D1, 20 % / 80 %";
  static constexpr bool chooses_weights = false;
  static constexpr pinnquad::detail::Split<double> shares{0.2, 0.0, 0.8};
};

/// A row of Table 2. `more_flights`: part of the main comparison, which is repeated on further flights.
template <int Id, class StructureType, class BatchNormType, class LambdaType, class DataSetType>
struct Model {
  static constexpr int id = Id;
  using Structure = StructureType;
  using BatchNorm = BatchNormType;
  using Lambda = LambdaType;
  using DataSet = DataSetType;
  static constexpr bool more_flights = id >= 2 && id <= 4;
};

/// docs/paper.md, deviation 16: models 7-10 are printed alike; the caption of Fig. 7 tells them apart.
using Table2 = std::tuple<Model<1, Linearized, Without, NoTerms, D1>,         //
                          Model<2, Vanilla, Without, NoTerms, D1>,            //
                          Model<3, Informed, Without, ConstantLambda, D1>,    //
                          Model<4, Informed, Without, CyclicLambda, D1>,      //
                          Model<5, Vanilla, With, NoTerms, D1>,               //
                          Model<6, Informed, With, CyclicLambda, D1>,         //
                          Model<7, Vanilla, With, NoTerms, D1Test40>,         //
                          Model<8, Informed, With, CyclicLambda, D1Test40>,   //
                          Model<9, Vanilla, With, NoTerms, D1Test80>,         //
                          Model<10, Informed, With, CyclicLambda, D1Test80>,  //
                          Model<11, Vanilla, With, NoTerms, D2>,              //
                          Model<12, Informed, With, CyclicLambda, D2>,        //
                          Model<13, Vanilla, With, NoTerms, D3>,              //
                          Model<14, Informed, With, CyclicLambda, D3>>;

/// Sec. 5: trainings of each network, and epochs of each.
inline constexpr int paper_seeds = 20, paper_epochs = 300;

/// Calls `function(Model<...>{})` for each row of Table 2, top to bottom.
template <class Function>
void each_model(const Function& function) {
  std::apply([&function](auto... rows) { (function(rows), ...); }, Table2());
}

}  // namespace study
