// SPDX-License-Identifier: MIT
// A model of any kind that `train` exports, its types erased: what judging, proving and refuting ask of it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/block.hpp"
#include "model/identity.hpp"
#include "model/response.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/row_set.hpp"
#include "training/derivatives.hpp"

namespace programs {

/// The answer of a model to a row.
struct AnsweredRow {
  pinnquad::Commands<double> commands{};  ///< in the model's own scalar
  AxisDerivatives derivatives{};          ///< in double; of a window by an acceleration that is held
  bool inside_envelope = true;
};

/// Features are those of the block, in physical units.
class AskedModel {
 public:
  AskedModel() = default;
  AskedModel(const AskedModel&) = delete;
  AskedModel& operator=(const AskedModel&) = delete;
  virtual ~AskedModel() = default;

  std::vector<std::string> names;             ///< of the features
  std::vector<int> taps;                      ///< where the angular acceleration of each tap begins, the present first
  SeenInstants seen;                          ///< of a window
  std::vector<pinnquad::ColumnName> columns;  ///< of a flight, beyond those that every flight has
  bool signed_sums = false;                   ///< pinnquad::is_signed_sums of its outputs
  bool affine_schema = false;                 ///< commands are affine in outputs and angular acceleration

  virtual pinnquad::Commands<double> commands(const std::vector<double>& x) const = 0;
  /// `held`: of a window the angular acceleration of all taps is moved; else the present alone.
  virtual AxisDerivatives derivatives(const std::vector<double>& x, bool held) const = 0;
  /// Calls `take(row, answer)` for the rows that have features, `row` counted through the set. Throws
  /// std::invalid_argument for a flight without a column that the model asks for.
  virtual void answer(const pinnquad::RowSet& rows,
                      const std::function<void(std::size_t, const AnsweredRow&)>& take) const = 0;
};

/// Of a block that was identified. Throws InputError where it contradicts itself (model/agreement.hpp). `is_to_fly`:
/// also where nothing is proven of a model that could be.
std::unique_ptr<const AskedModel> asked_model(const Block& block, const Identity& identity, bool is_to_fly = false);

/// The largest difference of its golden commands from those that its weights give.
inline double golden_difference(const Block& block, const AskedModel& model) {
  double largest = 0;
  const std::size_t size = block.envelope_lower.size();
  for (std::size_t vector = 0; vector < block.golden_count; ++vector) {
    const auto first = block.golden_features.begin() + static_cast<std::ptrdiff_t>(vector * size);
    const pinnquad::Commands<double> commands = model.commands({first, first + static_cast<std::ptrdiff_t>(size)});
    for (std::size_t rotor = 0; rotor < commands.size(); ++rotor) {
      const double golden = block.golden_commands[vector * commands.size() + rotor];
      const double difference = std::abs(commands[rotor] - golden);
      if (!(difference <= largest)) largest = difference;  // NaN stays
    }
  }
  return largest;
}

}  // namespace programs
