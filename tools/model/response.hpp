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

#include "pinnquad/model/certified_numbers.hpp"
#include "training/run_time_network.hpp"

namespace programs {

/// How fast each feature moves with what is asked, in physical units, between two ends.
struct Direction {
  std::vector<double> least, most;

  explicit Direction(std::size_t features) : least(features), most(features) {}
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

/// A base as pinnquad::AxisAligned and what is added to it, or the base alone; scalers' spreads.
inline Response response_along(const Direction& direction, const std::vector<NetworkSpec>& parts,
                               const std::vector<double>& parameters, const std::vector<double>& input_deviation,
                               const std::vector<double>& output_deviation) {
  const NetworkSpec& base = parts.front();
  const auto features = static_cast<std::size_t>(base.inputs);
  const double* const behind = parameters.data() + base.parameter_count();
  const std::vector<double> plain = detail::plain_parameters(base, parameters.data(), behind);
  Direction scaled(features);
  for (std::size_t i = 0; i < features; ++i) {
    scaled.least[i] = direction.least[i] / input_deviation[i];
    scaled.most[i] = direction.most[i] / input_deviation[i];
  }
  Response response;
  pinnquad::detail::weigh_intervals(plain.data(), base.inputs, 4, scaled.least.data(), scaled.most.data(),
                                    response.base_least.data(), response.base_most.data());
  for (std::size_t k = 0; k < 4; ++k) {
    response.base_least[k] *= output_deviation[k];
    response.base_most[k] *= output_deviation[k];
  }
  if (parts.size() < 2) return response;
  const NetworkSpec& residual = parts[1];
  if (!detail::has_path_bound(residual)) {
    response.residual_least.fill(-std::numeric_limits<double>::infinity());
    response.residual_most.fill(std::numeric_limits<double>::infinity());
    return response;
  }
  std::vector<int> widths;
  for (const LayerSpec& layer : residual.layers) {
    if (layer.size > 0) widths.push_back(layer.size);
  }
  const int widest = *std::max_element(widths.begin(), widths.end());
  std::vector<double> work(4 * static_cast<std::size_t>(widest));
  std::array<double, 4> lower{}, upper{};
  const auto bound = [&](const Direction& along) {
    Direction shown(0);
    for (std::size_t i = 0; i < features; ++i) {
      const int place = static_cast<int>(i);
      const bool hidden = std::any_of(residual.threes.begin(), residual.threes.end(),
                                      [place](int three) { return place >= three && place < three + 3; });
      if (hidden) continue;
      shown.least.push_back(along.least[i]);
      shown.most.push_back(along.most[i]);
    }
    pinnquad::path_bound_along(behind + (residual.bounded ? 8 : 0), residual.shown(), widths.data(),
                               static_cast<int>(widths.size()), shown.least.data(), shown.most.data(), work.data(),
                               widest, lower.data(), upper.data());
  };
  bound(scaled);
  response.residual_least = lower;
  response.residual_most = upper;
  for (std::size_t k = 0; k < 4; ++k) {  // a bound that clips has a slope from 0 to 1
    response.residual_least[k] = std::min(0.0, response.residual_least[k]) * output_deviation[k];
    response.residual_most[k] = std::max(0.0, response.residual_most[k]) * output_deviation[k];
  }
  return response;
}

}  // namespace programs
