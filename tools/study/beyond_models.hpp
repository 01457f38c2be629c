// SPDX-License-Identifier: MIT
// Contenders of the command `beyond`, their types hidden: a name and a function that trains. A further idea is a line
// of the list in beyond_models.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pinnquad/data/split.hpp"
#include "pinnquad/loss/context.hpp"
#include "training/trained_network.hpp"

namespace study {

/// The training to do: models and data.
struct BeyondTask {
  const pinnquad::RowSplit& split;
  pinnquad::GivenAirframe airframe;  ///< as the model is told it
  std::uint64_t seed = 0;
  int epochs = 0;
  std::function<bool()> goes_on;  ///< asked before each epoch
};

/// Its results.
struct BeyondTraining {
  std::shared_ptr<const programs::TrainedNetwork> model;  ///< none: it was stopped
  bool best_weights = false;                              ///< the validation rows chose the epoch
  bool residual_kept = false;
};

struct BeyondModel {
  std::string name;
  std::string summary;
  bool asks_airframe = false;  ///< a wrong one makes another model
  bool trained = true;         ///< false: the same for every seed
  std::function<BeyondTraining(const BeyondTask&)> train;
};

/// Its error is what the others are measured by.
inline constexpr const char* yardstick = "paper";

/// All, in the order of the tables.
std::vector<BeyondModel> beyond_models();

/// Those of `all` that are named, and always the yardstick. Throws std::invalid_argument, one line.
std::vector<BeyondModel> chosen_models(const std::vector<BeyondModel>& all, std::vector<std::string> names);

// Trainings, a translation unit each: what is slow to compile.
BeyondTraining train_network_on_physics(const BeyondTask& task);
BeyondTraining train_match(const BeyondTask& task);
BeyondTraining train_paper_with_altitude(const BeyondTask& task);
BeyondTraining train_ridge(const BeyondTask& task);
BeyondTraining train_structured_on_physics(const BeyondTask& task);
enum class Slopes { learnt, pinned };
BeyondTraining train_structured_on_rigid_body(const BeyondTask& task, Slopes slopes);
BeyondTraining train_path_bounded(const BeyondTask& task);

}  // namespace study
