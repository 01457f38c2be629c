// SPDX-License-Identifier: MIT
// A residual wrench from its block, which `pinnquad-study wrench` writes.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "logs/airframe_file.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "study/wrench_network.hpp"

namespace study {

using BlockWrench = WrenchNetwork<WrenchNet>;

/// True for a block that pinnquad-study wrench wrote.
inline bool is_wrench(const pinnquad::BlockModel& block) {
  using Features = WrenchFeatures;
  bool fits = !block.is_double() && block.features().size() == Features::size &&
              pinnquad::detail::describes<pinnquad::AccelerationOutputs>(block.schema()) &&
              pinnquad::detail::describes<WrenchNet>(block.answer());
  for (std::size_t i = 0; fits && i < std::size_t(Features::size); ++i) {
    fits = block.features()[static_cast<int>(i)].name == Features::names[i];
  }
  return fits;
}

/// Throws InputError, one line, for a block of another kind or of another vehicle.
inline void require_wrench(const pinnquad::BlockModel& block, const pinnquad::Airframe<double>& airframe,
                           const std::string& airframe_name) {
  if (!is_wrench(block)) {
    throw pinnquad::InputError(block.path(), 0, 0, "a residual wrench, as pinnquad-study wrench writes it",
                               "a model of another kind: " + block.answer());
  }
  if (!pinnquad::logs::same_numbers(block.airframe(), airframe)) {
    throw pinnquad::InputError(block.path(), 0, 0, "a residual wrench of the vehicle that flies, " + airframe_name,
                               "one of " + block.airframe_name());
  }
}

/// The block must stay where it is, and have passed require_wrench().
inline BlockWrench wrench_of(const pinnquad::BlockModel& block) {
  return block.with([]([[maybe_unused]] const auto& model) -> BlockWrench {
    if constexpr (std::is_same_v<decltype(model.parameters()), const float*>) {
      return BlockWrench(model.scales(), model.parameters());
    } else {
      throw std::logic_error("a wrench network is of float");
    }
  });
}

}  // namespace study
