// SPDX-License-Identifier: MIT
// Figures of closed loops: how far off each feed-forward flew, and whether a model lost the vehicle.
#pragma once

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/simulation/tracking.hpp"

namespace programs {

/// Where a closed loop was to be and was, every tenth of a second, seen from above.
struct FlownTrace {
  std::vector<double> time_s, planned_north_m, planned_east_m, north_m, east_m, error_m;

  /// For track(): it takes no memory while it flies.
  auto observer(double duration_s) {
    constexpr double interval_s = 0.1;
    *this = {};
    for (std::vector<double>* values : {&time_s, &planned_north_m, &planned_east_m, &north_m, &east_m, &error_m}) {
      values->reserve(static_cast<std::size_t>(duration_s / interval_s) + 2);
    }
    return [this](double now_s, const auto& point, const auto& vehicle, const auto&...) noexcept {
      if (now_s + 1e-9 < interval_s * static_cast<double>(time_s.size()) || time_s.size() == time_s.capacity()) return;
      time_s.push_back(now_s);
      planned_north_m.push_back(point.position_m[0]);
      planned_east_m.push_back(point.position_m[1]);
      north_m.push_back(vehicle.body.position_m[0]);
      east_m.push_back(vehicle.body.position_m[1]);
      error_m.push_back((point.position_m - vehicle.body.position_m).norm());
    };
  }
};

/// A flight with the model, and the same one without it.
struct FlownTraces {
  FlownTrace model, without;
};

/// The share of the control ticks that the model answered; of one that was not asked 0.
inline double answered_share(const pinnquad::FallbackCount& count) {
  return count.asked > 0 ? 1 - count.fallbacks() / static_cast<double>(count.asked) : 0.0;
}

inline nlohmann::json loop_figures(const pinnquad::TrackingResult<double>& flown) {
  constexpr auto ok = pinnquad::Status::ok;
  return {{"rmse_m", flown.rmse_m},
          {"largest_error_m", flown.max_error_m},
          {"flown_s", flown.flown_s},
          {"status", pinnquad::to_string(flown.status != ok ? flown.status : flown.declined)}};
}

/// True where the flight of `who` ended, or went further off than the figure is long and the analytic inverse
/// `without_jerk` is off. `flown`: the figure's `half_length_m`, and loop_figures() of both.
inline bool lost_vehicle(const nlohmann::json& flown, const char* who = "model") {
  if (!flown.contains(who)) return false;
  const nlohmann::json& figures = flown[who];
  return figures["status"] != to_string(pinnquad::Status::ok) ||
         !(figures["largest_error_m"] <=
           flown["without_jerk"]["largest_error_m"].get<double>() + 2 * flown["half_length_m"].get<double>());
}

}  // namespace programs
