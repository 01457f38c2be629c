// SPDX-License-Identifier: MIT
// The flight stacks' controller (pinnquad/control/autopilot/neural_controller.hpp) of a model that is known at run time
// alone, its guard, and an airframe as it has one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "flight/run_time_view.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace programs {

/// Features of a core, which is given the motion of the present alone. One set for the program: `of` says which.
struct CoreFeatures {
  template <class Scalar>
  using Inputs = pinnquad::MotionInputs<Scalar>;
  static constexpr int size = pinnquad::NamedFeatures::size;
  static constexpr int angular_acceleration = -1;
  static constexpr auto names = no_names<std::size_t(size)>();
  static constexpr auto units = names;

  static inline const pinnquad::RunTimeFeatures* of = nullptr;
  template <class Scalar>
  static inline std::array<Scalar, std::size_t(size)> last{};  ///< X made last: what a report's feature was

  template <class Scalar>
  static pinnquad::Status check(const pinnquad::MotionInputs<Scalar>& in) noexcept {
    return pinnquad::PaperFeatures::check<Scalar>(in);
  }
  template <class Scalar>
  static void extract(const pinnquad::MotionInputs<Scalar>& in, Scalar* x) noexcept {
    pinnquad::RunTimeInputs<Scalar> inputs;
    static_cast<pinnquad::MotionInputs<Scalar>&>(inputs) = in;
    for (int i = 0; i < size; ++i) x[i] = Scalar(0);
    if (of != nullptr) of->extract(&inputs, x);
    for (int i = 0; i < size; ++i) last<Scalar>[std::size_t(i)] = x[i];
  }
  static int place(const pinnquad::RunTimeFeatures& /*features*/, int feature) noexcept { return feature; }
  /// True for a model that a core can fly: of the motion of the present alone.
  static bool fits(const pinnquad::BlockModel& model) {
    const pinnquad::RunTimeFeatures& features = model.features();
    return !model.is_double() && features.size() <= size && features.window().taps == 1 &&
           features.column_count() == 0 && !features.asks_for_altitude();
  }
};

/// Limits of trust (docs/trust.md) as `struct <Model>Trust`; as made, everything is trusted. One for the program.
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

  /// Takes those of a block. False where it has none.
  static bool set(const pinnquad::RunTimeModel<float>& model) {
    const auto& records = model.records();
    if (records.trust == nullptr) return false;
    double limits[5];
    std::memcpy(limits, records.trust, sizeof limits);
    squared_distance_limit = limits[0];
    command_residual_factor = limits[1];
    command_residual_limit = limits[2];
    command_residual_cleared = limits[3];
    update_period_s = limits[4];
    const auto* numbers = static_cast<const float*>(static_cast<const void*>(records.trust + sizeof limits));
    const auto own = static_cast<std::size_t>(model.features().size());
    std::copy_n(numbers, own, distribution_mean.begin());
    numbers += own;
    for (std::size_t column = 0, at = 0; column < size; at += size - column, ++column) {
      for (std::size_t row = column; column < own && row < own; ++row) whitening[at + row - column] = *numbers++;
    }
    return true;
  }
};

/// The guard that flies.
using FlightStackController =
    pinnquad::autopilot::NeuralController<RunTimeShape<CoreFeatures, float>, RunTimeView<CoreFeatures, float>>;
using FallbackInverse = FlightStackController::Analytic;
using FlightStackGuard = pinnquad::Extend<FlightStackController::NetworkGuard, pinnquad::Fallback<FallbackInverse>>;

/// The airframe as flight code has it.
inline pinnquad::Airframe<float> flying_airframe(const pinnquad::BlockModel& model) {
  return model.with([](const auto& own) {
    if constexpr (std::is_same_v<std::decay_t<decltype(own.flown_airframe())>, pinnquad::Airframe<float>>) {
      return own.flown_airframe();
    } else {
      return pinnquad::airframe_in<float>(own.airframe());
    }
  });
}

}  // namespace programs
