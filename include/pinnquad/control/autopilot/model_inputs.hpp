// SPDX-License-Identifier: MIT
// The inputs of the model that a core flies: the motion wanted, and where the model asks for them the battery voltage
// and a window of the motions wanted before. Of a model of the present motion alone it is empty and does nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/features/input_history.hpp"
#include "pinnquad/inference/guard.hpp"

namespace pinnquad::autopilot::detail {

/// A column of a model, which a flight stack must measure.
template <class Column>
struct StackMeasures {
  static_assert(std::is_same_v<Column, BatteryVoltage>,
                "pinnquad: this model asks for a column that no flight stack gives the controller, that of "
                "StackMeasures<column>: battery_voltage is the only one (control/autopilot/model_inputs.hpp)");
  static constexpr bool known = true;
};

/// Inputs that a core fills: the motion, and columns behind it. False for others, such as an altitude above ground.
template <class Inputs>
inline constexpr bool core_fills = std::is_same_v<Inputs, MotionInputs<float>>;
template <class Base, class... Column>
inline constexpr bool core_fills<pinnquad::detail::InputsWithColumns<Base, float, Column...>> =
    (StackMeasures<Column>::known && ...) && core_fills<Base>;

/// Inputs of a model with a column or a window.
template <class Features, class = void>
class ModelInputs {
  using History = InputHistory<Features, float>;
  using Present = typename History::Present;
  static_assert(core_fills<Present>,
                "this controller is given no altitude above ground: it flies models that ask for the motion and the "
                "battery voltage alone (pinnquad train --altitude no)");

 public:
  static constexpr bool of_motion_alone = false;
  static constexpr bool asks_for_voltage = extra_column_names<Features>.size() > 0;

  /// Refused as other samples are; what is none (0, NaN) too. It is in force for voltage_limit_us.
  Status voltage([[maybe_unused]] std::uint64_t time_us, [[maybe_unused]] float volts) noexcept {
    if constexpr (asks_for_voltage) {
      const Status beyond = volts > 0 && volts <= most_plausible ? Status::ok : Status::out_of_range;
      return voltage_.accept(time_us, volts, is_finite(volts) ? beyond : Status::not_finite);
    } else {
      return Status::ok;
    }
  }
  std::uint32_t refused() const noexcept { return voltage_.refused(); }

  /// A tick begins.
  void tick(std::uint64_t now_us) noexcept { now_us_ = now_us; }
  bool voltage_is_fresh() const noexcept { return !asks_for_voltage || voltage_.fresh(now_us_, voltage_limit_us); }

  /// The inputs of a motion wanted in this tick. Without a fresh voltage they are not finite, until the window is
  /// complete `warming_up`: the network declines them.
  PINNQUAD_NOINLINE const typename History::Inputs& take(const MotionInputs<float>& motion) noexcept {
    static_cast<void>(history_.take(present(motion), seconds_of(now_us_)));
    return history_.inputs();
  }
  /// Those of a motion that has lasted as long as the window, until the next call. The past stays as it is.
  PINNQUAD_NOINLINE const typename History::Inputs& lasting(const MotionInputs<float>& motion) noexcept {
    return history_.lasting(present(motion));
  }
  /// Forgets the past: after a reset of the estimator its motions are of another frame.
  void clear() noexcept { history_.clear(); }

 private:
  Present present(const MotionInputs<float>& motion) const noexcept {
    Present result;
    static_cast<MotionInputs<float>&>(result) = motion;
    const float volts = voltage_is_fresh() ? voltage_.value() : std::numeric_limits<float>::quiet_NaN();
    set_columns(result, &volts);
    return result;
  }

  std::uint64_t now_us_ = 0;
  Input<float> voltage_;
  History history_;
};

/// A model of the present motion alone.
template <class Features>
class ModelInputs<Features,
                  std::enable_if_t<std::is_same_v<typename Features::template Inputs<float>, MotionInputs<float>>>> {
 public:
  static constexpr bool of_motion_alone = true;
  static constexpr bool asks_for_voltage = false;

  static Status voltage(std::uint64_t /*time_us*/, float /*volts*/) noexcept { return Status::ok; }
  static constexpr std::uint32_t refused() noexcept { return 0; }
  static void tick(std::uint64_t /*now_us*/) noexcept {}
  static constexpr bool voltage_is_fresh() noexcept { return true; }
  static const MotionInputs<float>& take(const MotionInputs<float>& motion) noexcept { return motion; }
  static const MotionInputs<float>& lasting(const MotionInputs<float>& motion) noexcept { return motion; }
  static void clear() noexcept {}
};

}  // namespace pinnquad::autopilot::detail
