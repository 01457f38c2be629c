// SPDX-License-Identifier: MIT
// A model from a block, as a search of a counterexample (model/counterexample.hpp) asks it.
#pragma once

#include <utility>
#include <vector>

#include "model/counterexample.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// The model that is searched where nothing is proven.
inline SearchedModel searched_model(const pinnquad::BlockModel& model) {
  SearchedModel searched;
  searched.lower = model.envelope_lower();
  searched.upper = model.envelope_upper();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AskedMore now{axis, false, {}}, held{axis, true, {}};
    for (const pinnquad::BlockModel::AccelerationPlace& place : model.angular_accelerations()) {
      if (place.axis != axis) continue;
      held.places.push_back(place.feature);
      if (place.is_present) now.places.push_back(place.feature);
    }
    const bool is_asked = !now.places.empty(), differ = now.places.size() < held.places.size();
    if (is_asked) searched.ways.push_back(std::move(now));
    if (is_asked && differ) searched.ways.push_back(std::move(held));
  }
  searched.derivatives = [&model, ways = searched.ways](const std::vector<double>& x) {
    bool window = false;
    for (const AskedMore& way : ways) window = window || way.held;
    const pinnquad::AxisSlopes now = model.derivatives(x, false);
    const pinnquad::AxisSlopes held = window ? model.derivatives(x, true) : now;
    std::vector<double> all;
    for (const AskedMore& way : ways) all.push_back(way.held ? held[way.axis] : now[way.axis]);
    return all;
  };
  searched.sums = [&model](const std::vector<double>& x) { return model.signed_sums(model.commands(x)); };
  for (int vector = 0; vector < model.golden_count(); ++vector)
    searched.starts.push_back(model.golden_features(vector));
  return searched;
}

}  // namespace programs
