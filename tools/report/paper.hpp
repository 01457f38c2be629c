// SPDX-License-Identifier: MIT
// Figures of the paper: Table 2 (its models), Table 3 (its results) and the training times of Sec. 5.4. Typed once,
// here. Gu, Primatesta, Rizzo: Physics-informed Neural Network for Quadrotor Dynamical Modeling, Robotics and
// Autonomous Systems 171 (2024).
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "report/rows.hpp"

namespace programs {

/// The four figures of Table 3: its columns and those of rows.csv.
struct Measure {
  const char* column;  ///< of rows.csv
  const char* label;
  const char* unit;
  double scale;  ///< from the unit of rows.csv to the one shown
};

inline constexpr std::array<Measure, 4> table3_measures = {{{"mae", "mean absolute error", "1e-3", 1e3},
                                                            {"angle_difference_deg_roll", "angle, roll", "deg", 1},
                                                            {"angle_difference_deg_pitch", "angle, pitch", "deg", 1},
                                                            {"angle_difference_deg_yaw", "angle, yaw", "deg", 1}}};

enum class Structure { linearized, vanilla, physics_informed };
enum class PhysicsTerm { none, constant, annealed };
/// A flight, and which share of it trains and tests.
enum class PaperData { d1, d1_test_40, d1_test_80, d2, d3 };

/// A line of Table 2. docs/paper.md, deviation 16: models 7-10 are printed alike; the caption of Fig. 7 tells them
/// apart.
struct PaperModel {
  int id;
  Structure structure;
  bool batch_norm;
  PhysicsTerm term;
  PaperData data;
};

// clang-format off
inline constexpr std::array<PaperModel, study_models> table2 = {{
    // ID  structure                batch norm  physics term           data set
    { 1, Structure::linearized,       false, PhysicsTerm::none,     PaperData::d1},
    { 2, Structure::vanilla,          false, PhysicsTerm::none,     PaperData::d1},
    { 3, Structure::physics_informed, false, PhysicsTerm::constant, PaperData::d1},
    { 4, Structure::physics_informed, false, PhysicsTerm::annealed, PaperData::d1},
    { 5, Structure::vanilla,          true,  PhysicsTerm::none,     PaperData::d1},
    { 6, Structure::physics_informed, true,  PhysicsTerm::annealed, PaperData::d1},
    { 7, Structure::vanilla,          true,  PhysicsTerm::none,     PaperData::d1_test_40},
    { 8, Structure::physics_informed, true,  PhysicsTerm::annealed, PaperData::d1_test_40},
    { 9, Structure::vanilla,          true,  PhysicsTerm::none,     PaperData::d1_test_80},
    {10, Structure::physics_informed, true,  PhysicsTerm::annealed, PaperData::d1_test_80},
    {11, Structure::vanilla,          true,  PhysicsTerm::none,     PaperData::d2},
    {12, Structure::physics_informed, true,  PhysicsTerm::annealed, PaperData::d2},
    {13, Structure::vanilla,          true,  PhysicsTerm::none,     PaperData::d3},
    {14, Structure::physics_informed, true,  PhysicsTerm::annealed, PaperData::d3},
}};
// clang-format on

/// As Table 2 calls them.
inline const char* structure_words(Structure structure) {
  switch (structure) {
    case Structure::linearized: return "linearized model, Eq. (3)";
    case Structure::vanilla: return "vanilla";
    case Structure::physics_informed: break;
  }
  return "physics-informed";
}
inline const char* data_words(PaperData data) {
  switch (data) {
    case PaperData::d1: return "D1";
    case PaperData::d2: return "D2";
    case PaperData::d3: return "D3";
    case PaperData::d1_test_40:
    case PaperData::d1_test_80: break;
  }
  return "D1, reduced";
}
/// Training / validation / test, % of the flight.
inline const char* split_words(const PaperModel& model) {
  if (model.structure == Structure::linearized) return "– / – / 20";
  if (model.data == PaperData::d1_test_40) return "20 / – / 40";
  return model.data == PaperData::d1_test_80 ? "20 / – / 80" : "60 / 20 / 20";
}

inline const PaperModel& paper_model(int id) { return table2[static_cast<std::size_t>(id - 1)]; }

/// As the caption of Fig. 7 tells the losses apart.
inline const char* loss_words(int model) {
  switch (paper_model(model).term) {
    case PhysicsTerm::constant: return "constant weight";
    case PhysicsTerm::annealed: return "annealed";
    case PhysicsTerm::none: break;
  }
  return "vanilla";
}

/// A model as a table or a drawing names it.
inline std::string model_words(int model) {
  return model == 1 ? "linearized" : std::string(loss_words(model)) + (paper_model(model).batch_norm ? ", BN" : "");
}

/// An entry of Table 3 in the units of rows.csv; the deviation is 0 for model 1, which has none.
struct PaperEntry {
  double mean;
  double deviation;
};

/// Table 3, by model: mean absolute error, then the ellipses' angles in roll, pitch, yaw (degrees).
inline constexpr std::array<std::array<PaperEntry, 4>, study_models> table3 = {{
    {{{1.023e-1, 0}, {1.321, 0}, {6.327, 0}, {9.200e-2, 0}}},
    {{{3.867e-3, 2.424e-4}, {22.669, 4.603}, {25.309, 4.626}, {1.402, 0.466}}},
    {{{3.775e-3, 3.525e-4}, {12.507, 1.666}, {1.706, 1.498}, {0.118, 9.611e-2}}},
    {{{3.493e-3, 3.296e-4}, {16.550, 2.517}, {23.543, 4.238}, {0.463, 0.204}}},
    {{{2.625e-3, 1.160e-4}, {26.409, 4.746}, {28.281, 5.491}, {0.499, 0.118}}},
    {{{2.480e-3, 1.030e-4}, {24.337, 3.555}, {28.604, 4.618}, {0.273, 0.0677}}},
    {{{4.874e-3, 6.764e-4}, {33.717, 4.994}, {22.997, 4.762}, {0.347, 0.142}}},
    {{{3.793e-3, 3.444e-4}, {6.550, 1.546}, {6.472, 1.478}, {0.136, 4.227e-2}}},
    {{{5.981e-3, 1.190e-3}, {40.489, 7.631}, {23.196, 6.782}, {0.269, 0.141}}},
    {{{4.405e-3, 6.185e-4}, {12.053, 1.176}, {1.171, 1.383}, {0.316, 3.021e-2}}},
    {{{2.747e-4, 4.570e-5}, {4.582, 1.829}, {1.615, 0.796}, {57.040, 11.849}}},
    {{{2.580e-4, 4.290e-5}, {5.662, 2.031}, {1.724, 0.631}, {23.399, 5.521}}},
    {{{4.771e-3, 3.661e-4}, {9.526, 4.686}, {18.904, 5.065}, {6.954, 0.997}}},
    {{{4.525e-3, 3.087e-4}, {5.754, 3.315}, {16.587, 3.202}, {1.729, 0.716}}},
}};

inline const PaperEntry& paper_entry(int model, std::size_t measure) {
  return table3[static_cast<std::size_t>(model - 1)][measure];
}

/// docs/paper.md, deviation 19: a leading digit may be lost in two angles in pitch, 1.706 of model 3 and 1.171 of model
/// 10. They are marked, and no claim is judged by them.
constexpr bool suspect_entry(int model, std::size_t measure) { return measure == 2 && (model == 3 || model == 10); }

/// Pairs to compare: candidate against baseline, on the same seeds.
struct ModelPair {
  int baseline;
  int candidate;
};

inline constexpr std::array<ModelPair, 8> compared_pairs = {
    {{2, 4}, {2, 3}, {3, 4}, {5, 6}, {7, 8}, {9, 10}, {11, 12}, {13, 14}}};

/// Sec. 5: epochs of a training, and trainings of each network; what a study runs if it is told nothing else.
inline constexpr int paper_epochs = 300;
inline constexpr int paper_seeds = 20;

/// Sec. 5.4: seconds of one training of models 2 and 4 (300 epochs), PyTorch with CUDA on a laptop's RTX 3060.
inline constexpr double paper_vanilla_s = 234;
inline constexpr double paper_physics_informed_s = 373;

}  // namespace programs
