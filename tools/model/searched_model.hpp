// SPDX-License-Identifier: MIT
// A model from a block, as a search of a counterexample (model/counterexample.hpp) asks it.
#pragma once

#include <utility>
#include <vector>

#include "model/asked_model.hpp"
#include "model/block.hpp"
#include "model/counterexample.hpp"
#include "model/identity.hpp"

namespace programs {

/// The model that is searched where nothing is proven.
inline SearchedModel searched_model(const Block& block, const Identity& identity, const AskedModel& model) {
  SearchedModel searched;
  searched.lower = block.envelope_lower;
  searched.upper = block.envelope_upper;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AskedMore held{axis, true, {}};
    for (const int place : model.taps) held.places.push_back(static_cast<std::size_t>(place) + axis);
    searched.ways.push_back({axis, false, {held.places.front()}});
    if (model.taps.size() > 1) searched.ways.push_back(std::move(held));
  }
  searched.derivatives = [&model, ways = searched.ways](const std::vector<double>& x) {
    const AxisDerivatives now = model.derivatives(x, false);
    const AxisDerivatives held = model.taps.size() > 1 ? model.derivatives(x, true) : now;
    std::vector<double> all;
    for (const AskedMore& way : ways) all.push_back(way.held ? held[way.axis] : now[way.axis]);
    return all;
  };
  const RunTimeAirframe airframe(identity.airframe.name, identity.airframe.value);
  const std::array<std::array<double, pinnquad::rotor_count>, 3> signs = {
      airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()};
  searched.sums = [&model, signs](const std::vector<double>& x) {
    const pinnquad::Commands<double> commands = model.commands(x);
    return std::array<double, 3>{pinnquad::signed_sum(signs[0], commands), pinnquad::signed_sum(signs[1], commands),
                                 pinnquad::signed_sum(signs[2], commands)};
  };
  const std::size_t size = block.envelope_lower.size();
  for (std::size_t vector = 0; vector < block.golden_count; ++vector) {
    const auto first = block.golden_features.begin() + static_cast<std::ptrdiff_t>(vector * size);
    searched.starts.emplace_back(first, first + static_cast<std::ptrdiff_t>(size));
  }
  return searched;
}

}  // namespace programs
