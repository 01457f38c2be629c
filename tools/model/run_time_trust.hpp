// SPDX-License-Identifier: MIT
// Limits of trust (docs/trust.md) from the header that `pinnquad train` wrote beside a model, read without a compiler;
// and a type that holds them, where flying code wants constants.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "model/header_file.hpp"

namespace programs {

/// The contents of trust.hpp.
struct TrustLimits {
  std::string path;
  std::vector<double> mean, whitening;
  double squared_distance_limit = 0;
  double command_residual_factor = 0, command_residual_limit = 0, command_residual_cleared = 0;
  double update_period_s = 0;
};

/// Reads earlier names too (exported/renamed.hpp). Throws InputError, one line.
inline TrustLimits read_trust(const std::string& path) {
  const HeaderFile header(path, "training_data_hash", "limits of trust, as pinnquad train writes them (trust.hpp)");
  TrustLimits limits;
  limits.path = path;
  limits.mean = header.numbers("distribution_mean");
  limits.whitening = header.numbers("whitening", limits.mean.size() * (limits.mean.size() + 1) / 2);
  const auto positive = [&header](const char* name, double most) {
    const double value = header.number(name);
    if (!(value > 0 && value <= most))
      header.refuse(name, std::string("a number above 0 in `") + name + "`", "another");
    return value;
  };
  constexpr double any = 1e30;
  const bool earlier = header.has("innovation_limit");
  limits.squared_distance_limit = positive(earlier ? "distance_limit" : "squared_distance_limit", any);
  limits.command_residual_factor = positive(earlier ? "innovation_factor" : "command_residual_factor", 1);
  limits.command_residual_limit = positive(earlier ? "innovation_limit" : "command_residual_limit", any);
  limits.command_residual_cleared =
      positive(earlier ? "innovation_cleared" : "command_residual_cleared", limits.command_residual_limit);
  limits.update_period_s = positive("update_period_s", any);
  return limits;
}

/// As `struct <Model>Trust`; as made, everything is trusted. One for the program: set() says which.
template <class FeatureSet>
struct RunTimeTrust {
  static constexpr auto size = static_cast<std::size_t>(FeatureSet::size);
  static constexpr double unlimited = 1e30;

  static inline std::array<float, size> distribution_mean{};
  static inline std::array<float, size*(size + 1) / 2> whitening{};
  static inline double squared_distance_limit = unlimited;
  static inline double command_residual_factor = 1;
  static inline double command_residual_limit = unlimited;
  static inline double command_residual_cleared = unlimited;
  static inline double update_period_s = 1;

  /// Throws InputError for limits of other features.
  static void set(const TrustLimits& limits) {
    if (limits.mean.size() != size) {
      throw pinnquad::InputError(limits.path, 0, 0, "limits of a model of " + std::to_string(size) + " features",
                                 std::to_string(limits.mean.size()));
    }
    const auto take = [](const std::vector<double>& from, auto& to) {
      std::transform(from.begin(), from.end(), to.begin(), [](double value) { return static_cast<float>(value); });
    };
    take(limits.mean, distribution_mean);
    take(limits.whitening, whitening);
    squared_distance_limit = limits.squared_distance_limit;
    command_residual_factor = limits.command_residual_factor;
    command_residual_limit = limits.command_residual_limit;
    command_residual_cleared = limits.command_residual_cleared;
    update_period_s = limits.update_period_s;
  }
};

}  // namespace programs
