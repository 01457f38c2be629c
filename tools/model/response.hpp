// SPDX-License-Identifier: MIT
// How the sums of a structured model's commands respond to what moves several features at once: to more thrust, and to
// an angular acceleration that is held, with the body rates that it makes. Of the base exactly, of a residual between
// bounds that hold at every input (docs/certificate.md).
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/path_bound.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// How fast each feature moves with what is asked, in physical units, between two ends.
struct Direction : Intervals {
  explicit Direction(std::size_t features) : Intervals{std::vector<double>(features), std::vector<double>(features)} {}
  void set(std::size_t feature, double rate) { least[feature] = most[feature] = rate; }
};

/// "w_x[-3]": a name, and how many periods from the present.
struct TapName {
  std::string_view name;
  std::string_view suffix;  ///< "[-3]", or nothing
  int periods = 0;

  explicit TapName(const std::string& text)
      : name(std::string_view(text).substr(0, text.find('['))), suffix(std::string_view(text).substr(name.size())) {
    if (!suffix.empty()) periods = std::atoi(text.c_str() + name.size() + 1);
  }
};

/// The instants that features see.
struct SeenInstants {
  double period_s = 0;    ///< of a window; 0 without one
  double earliest_s = 0;  ///< from the present
};

/// An angular acceleration larger by 1 rad/s^2 from the window's first instant on: by then the body rates of a tap that
/// is t behind the first have grown by t, and products of body rates by t times the other rate, which is anywhere in
/// the envelope. Attitude, velocity and specific force stand as they are. Nothing where a product's other rate is no
/// feature.
inline std::optional<Direction> held_with_rates(const std::vector<std::string>& names, std::size_t axis,
                                                const SeenInstants& seen, const std::vector<double>& envelope_lower,
                                                const std::vector<double>& envelope_upper) {
  Direction direction(names.size());
  const char own = "xyz"[axis];
  for (std::size_t i = 0; i < names.size(); ++i) {
    const TapName feature(names[i]);
    const double elapsed = feature.periods * seen.period_s - seen.earliest_s;
    if (feature.name == std::string("wdot_") + own) direction.set(i, 1);
    if (feature.name == std::string("w_") + own) direction.set(i, elapsed);
    if (feature.name.size() != 4 || feature.name.substr(0, 2) != "w_") continue;
    const std::string_view factors = feature.name.substr(2);  // "yz" of w_y w_z
    if (factors.find(own) == std::string_view::npos) continue;
    const char other = factors[0] == own ? factors[1] : factors[0];
    const auto rate = std::find(names.begin(), names.end(), std::string("w_") + other + std::string(feature.suffix));
    if (rate == names.end()) return {};
    const auto at = static_cast<std::size_t>(rate - names.begin());
    direction.least[i] = elapsed * envelope_lower[at];
    direction.most[i] = elapsed * envelope_upper[at];
  }
  return direction;
}

/// More thrust asked at all instants: less specific force along z, FRD. Nothing of features that have none.
inline std::optional<Direction> more_thrust(const std::vector<std::string>& names) {
  Direction direction(names.size());
  bool any = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!pinnquad::detail::is_thrust(names[i])) continue;
    direction.set(i, -1);
    any = true;
  }
  return any ? std::optional(direction) : std::nullopt;
}

/// Between which the derivatives of the four sums stay. Of a residual whose paths nobody can bound infinite.
struct Response {
  std::array<double, 4> base_least{}, base_most{};
  std::array<double, 4> residual_least{}, residual_most{};

  double least(std::size_t sum) const { return base_least[sum] + residual_least[sum]; }
};

namespace detail {

/// The base's output k, standardised, along a direction.
template <class Scalar>
void respond(const pinnquad::RunTimeNetwork::Part& base, const Scalar* parameters, std::size_t k,
             const Direction& scaled, Response& response) {
  const auto add = [&](Scalar weight, int feature) {
    const auto i = static_cast<std::size_t>(feature);
    const double slope = static_cast<double>(weight);
    response.base_least[k] += slope * (slope < 0 ? scaled.most[i] : scaled.least[i]);
    response.base_most[k] += slope * (slope < 0 ? scaled.least[i] : scaled.most[i]);
  };
  const Scalar* weights = parameters + 3 * base.three_count + static_cast<int>(k) * base.shown();
  base.each_shown([&](int feature) { add(*weights++, feature); });
  for (int tap = 0; k > 0 && tap < base.three_count; ++tap) {
    const int axis = static_cast<int>(k) - 1;
    add(parameters[3 * tap + axis], base.threes[tap] + axis);
  }
}

}  // namespace detail

/// Of a network whose first part is axis-aligned, alone or with a residual, between scalers.
template <class Scalar>
Response response_along(const Direction& direction, const pinnquad::RunTimeNetwork& network, const Scalar* parameters,
                        const Scalar* input_deviation, const Scalar* output_deviation) {
  const pinnquad::RunTimeNetwork::Part& base = network.part(0);
  const auto features = static_cast<std::size_t>(base.inputs);
  Direction scaled(features);
  for (std::size_t i = 0; i < features; ++i) {
    scaled.least[i] = direction.least[i] / static_cast<double>(input_deviation[i]);
    scaled.most[i] = direction.most[i] / static_cast<double>(input_deviation[i]);
  }
  Response response;
  for (std::size_t k = 0; k < 4; ++k) {
    detail::respond(base, parameters, k, scaled, response);
    const auto deviation = static_cast<double>(output_deviation[k]);
    response.base_least[k] *= deviation;
    response.base_most[k] *= deviation;
  }
  if (network.part_count() < 2) return response;
  const pinnquad::RunTimeNetwork::Part& residual = network.part(1);
  const std::vector<std::size_t> widths = bounded_widths(network, residual);
  if (widths.empty()) {
    response.residual_least.fill(-std::numeric_limits<double>::infinity());
    response.residual_most.fill(std::numeric_limits<double>::infinity());
    return response;
  }
  Intervals shown;
  residual.each_shown([&](int feature) {
    shown.least.push_back(scaled.least[std::size_t(feature)]);
    shown.most.push_back(scaled.most[std::size_t(feature)]);
  });
  const Intervals bound =
      path_bound_along(parameters + base.parameter_count + (residual.bounded ? 8 : 0), widths, shown);
  for (std::size_t k = 0; k < 4; ++k) {  // a bound that clips has a slope from 0 to 1
    const auto deviation = static_cast<double>(output_deviation[k]);
    response.residual_least[k] = std::min(0.0, bound.least[k]) * deviation;
    response.residual_most[k] = std::max(0.0, bound.most[k]) * deviation;
  }
  return response;
}

}  // namespace programs
