// SPDX-License-Identifier: MIT
// The flight stacks' controller (pinnquad/control/autopilot/neural_controller.hpp) of a model that is known at run time
// alone, its guard, and an airframe as it has one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "flight/block_feed_forward.hpp"
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
    pinnquad::RunTimeFeatures::Inputs<Scalar> inputs;
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

/// Features of a core with a window or the battery voltage. One set for the program: `of` says which.
struct PastCoreFeatures : FlightFeatures<> {
  static constexpr std::array<const char*, 1> column_names = {pinnquad::BatteryVoltage::name};
  static constexpr std::array<const char*, 1> column_units = {pinnquad::BatteryVoltage::unit};

  static inline const pinnquad::RunTimeFeatures* of = nullptr;
  template <class Scalar>
  static inline std::array<Scalar, std::size_t(size)> last{};  ///< X made last: what a report's feature was

  template <class Scalar>
  static void extract(const FlightInputs<Scalar>& in, Scalar* x) noexcept {
    FlightFeatures<>::extract(in, x);
    for (int i = 0; i < size; ++i) last<Scalar>[std::size_t(i)] = x[i];
  }
  /// True for a model that a core can fly: of the motion, its past, and the battery voltage.
  static bool fits(const pinnquad::BlockModel& model) {
    const pinnquad::RunTimeFeatures& features = model.features();
    const bool known = features.column_count() == 0 ||
                       (features.column_count() == 1 && features.column(0).name == pinnquad::BatteryVoltage::name &&
                        features.column(0).unit == pinnquad::BatteryVoltage::unit);
    return !model.is_double() && known && features.window().causal && !features.asks_for_altitude();
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

namespace pinnquad {

/// Of a core, which gives it the motion and the voltage.
template <class Scalar, int MostSamples>
class InputHistory<programs::PastCoreFeatures, Scalar, MostSamples, void> {
  using All = InputHistory<programs::FlightFeatures<>, Scalar>;

 public:
  using Inputs = typename All::Inputs;
  using Present = typename WithColumns<PaperFeatures, BatteryVoltage>::template Inputs<Scalar>;

  InputHistory() : past_(*programs::PastCoreFeatures::of) {}

  Status take(const Present& present, double time_s) noexcept { return past_.take(all(present), time_s); }
  const Inputs& lasting(const Present& present) noexcept { return past_.lasting(all(present)); }
  const Inputs& inputs() const noexcept { return past_.inputs(); }
  void clear() noexcept { past_.clear(); }

 private:
  static typename All::Present all(const Present& present) noexcept {
    typename All::Present result;
    static_cast<MotionInputs<Scalar>&>(result) = present;
    result.columns[0] = present.columns[0];
    return result;
  }

  All past_;
};

}  // namespace pinnquad
