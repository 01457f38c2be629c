// SPDX-License-Identifier: MIT
#include "training/log_least_squares.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "pinnquad/regression/ridge.hpp"

namespace programs {

namespace {

pinnquad::RegressionSums sum_of(const std::vector<pinnquad::RegressionSums>& groups) {
  if (groups.empty()) throw std::invalid_argument("no row has all features that are asked for");
  pinnquad::RegressionSums all = groups.front();
  for (std::size_t i = 1; i < groups.size(); ++i) all += groups[i];
  return all;
}

/// The columns that the thrust and the torques about x, y, z depend on.
const std::array<std::vector<std::string>, 4> physics_terms = {{{"s_z", "v_bz", "vv_bz", "battery_voltage"},
                                                                {"wdot_x", "w_yz", "w_x", "v_by"},
                                                                {"wdot_y", "w_zx", "w_y", "v_bx"},
                                                                {"wdot_z", "w_xy", "w_z"}}};

}  // namespace

pinnquad::AffineMap solved_ridge(const std::vector<pinnquad::RegressionSums>& groups) {
  const double penalty = groups.size() < 2 ? 0.0 : pinnquad::choose_penalty(groups);
  return pinnquad::fit_ridge(sum_of(groups), penalty);
}

pinnquad::AffineMap solved_least_squares(const std::vector<pinnquad::RegressionSums>& groups) {
  return pinnquad::fit_ridge(sum_of(groups), 0.0);
}

pinnquad::AffineMap solved_physics(const pinnquad::RegressionSums& sums, const std::vector<std::string>& names,
                                   const pinnquad::AllocationMatrix<double>& allocation,
                                   const pinnquad::Scaler<double, pinnquad::rotor_count>& commands) {
  pinnquad::AllocationMatrix<double> inverse{};
  if (pinnquad::invert_allocation(allocation, inverse) != pinnquad::Status::ok) {
    throw std::invalid_argument("the airframe's rotors can't make every thrust and torque");
  }
  std::array<pinnquad::AffineMap, 4> wrench;
  for (std::size_t part = 0; part < wrench.size(); ++part) {
    std::vector<bool> taken;
    for (const std::string& name : names) {
      const std::vector<std::string>& terms = physics_terms[part];
      taken.push_back(std::find(terms.begin(), terms.end(), name) != terms.end());
    }
    wrench[part] = pinnquad::fit_ridge(sums, 0.0, taken);
  }
  pinnquad::AffineMap map;
  map.inputs = sums.inputs();
  map.outputs = pinnquad::rotor_count;
  const auto inputs = static_cast<std::size_t>(map.inputs);
  map.weights.assign(inputs * pinnquad::rotor_count, 0.0);
  for (std::size_t rotor = 0; rotor < pinnquad::rotor_count; ++rotor) {
    map.intercept.push_back(-commands.mean[rotor] / commands.standard_deviation[rotor]);
    for (std::size_t part = 0; part < wrench.size(); ++part) {
      const double share = inverse[rotor][part] / commands.standard_deviation[rotor];
      map.intercept[rotor] += share * wrench[part].intercept[part];
      for (std::size_t i = 0; i < inputs; ++i) {
        map.weights[rotor * inputs + i] += share * wrench[part].weights[part * inputs + i];
      }
    }
  }
  return map;
}

}  // namespace programs
