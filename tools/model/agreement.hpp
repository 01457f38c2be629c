// SPDX-License-Identifier: MIT
// The facts that a block of known shape says twice, compared as ModelView::open() does (exported/model_agreement.hpp),
// and its golden vectors replayed as the self test does.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/asked_model.hpp"
#include "model/block.hpp"
#include "model/identity.hpp"
#include "model/structure_certificate.hpp"
#include "pinnquad/exported/model_agreement.hpp"

namespace programs {
namespace detail {

[[noreturn]] inline void refuse(const Block& block, const std::string& expected, const std::string& found) {
  throw pinnquad::InputError(block.path, 0, 0, expected, found);
}

/// As pinnquad::detail::StatedStructure: a base in closed form, or one with a residual between bounds.
inline bool has_stated_structure(const Identity& identity) {
  const std::vector<NetworkSpec>& parts = identity.networks;
  return parts.front().axis_aligned && (parts.size() == 1 || (parts.size() == 2 && parts[1].bounded));
}

template <class Scalar>
bool true_residual_range(const Block& block, const Identity& identity) {
  const auto in_scalar = [](const std::vector<double>& values) {
    std::vector<Scalar> result;
    for (const double value : values) result.push_back(static_cast<Scalar>(value));
    return result;
  };
  const std::vector<NetworkSpec>& parts = identity.networks;
  if (!has_stated_structure(identity) || block.residual_range.empty()) return true;
  const auto range = in_scalar(block.residual_range), parameters = in_scalar(block.parameters),
             spread = in_scalar(block.output_deviation);
  const Scalar* bounds = parameters.data() + parts.front().parameter_count();
  return pinnquad::detail::same_residual_range(range.data(), range.data() + spread.size(), parts.size() > 1, bounds,
                                               spread.data(), spread.size());
}

/// Against what its airframe is.
inline void require_airframe(const Block& block, const Identity& identity) {
  const pinnquad::Airframe<double>& airframe = identity.airframe.value;
  const auto own = pinnquad::allocation(airframe);
  const auto entry = [&block](std::size_t row, std::size_t column) { return block.allocation[4 * row + column]; };
  const auto expected = [&own](std::size_t row, std::size_t column) { return own[row][column]; };
  if (!block.allocation.empty() && !pinnquad::detail::same_allocation<double>(entry, expected)) {
    refuse(block, "the allocation of its airframe", "another");
  }
  const auto torque_signs = pinnquad::motor_torque_signs(airframe);
  for (std::size_t i = 0; has_stated_structure(identity) && i < block.slope_signs.size(); ++i) {
    if (pinnquad::detail::true_slope_sign(block.slope_signs[i], torque_signs[i / 3][i % 3])) continue;
    refuse(block, "slope signs of the torques that its rotors make", "another of rotor " + std::to_string(i / 3 + 1));
  }
}

}  // namespace detail

/// Throws InputError, one line.
template <class Features>
void require_agreement(const Block& block, const Identity& identity) {
  using Window = pinnquad::detail::WindowOf<Features>;
  if (block.has_records) {
    if (block.window_taps != static_cast<std::uint32_t>(Window::taps) || block.causal != Window::causal) {
      detail::refuse(block, "the window of its features", "another");
    }
    if (Window::period_s > 0 && !pinnquad::detail::same_period(block.sample_period_s, Window::period_s)) {
      detail::refuse(block, "the sample period of its features' window", "another");
    }
    std::vector<std::string> columns;
    for (std::size_t i = 0; i < pinnquad::extra_column_names<Features>.size(); ++i) {
      columns.emplace_back(pinnquad::extra_column_names<Features>[i]);
      columns.emplace_back(pinnquad::extra_column_units<Features>[i]);
    }
    if (block.columns != columns) detail::refuse(block, "the extra columns of its features", "others");
  }
  detail::require_airframe(block, identity);
  const bool same = block.is_double ? detail::true_residual_range<double>(block, identity)
                                    : detail::true_residual_range<float>(block, identity);
  if (!same) detail::refuse(block, "a range of the residual as its parameters bound it", "another");
}

/// The same of its weights: throws InputError where they don't give the golden commands, and where nothing is proven of
/// a model that says proven signs, or, of one that is to fly, has the structure.
inline void require_self_test(const Block& block, const Identity& identity, const AskedModel& model, bool is_to_fly) {
  if (!(golden_difference(block, model) <= pinnquad::golden_tolerance)) {
    detail::refuse(block, "golden commands that its weights give", "others");
  }
  if (!is_to_fly && block.slope_signs.empty()) return;
  const std::optional<pinnquad::Certificate> certificate = certificate_of_block(block, identity, model);
  if (certificate && !certificate->proven()) {
    detail::refuse(block, "slopes and bounds of which its certificate is proven", "others");
  }
}

}  // namespace programs
