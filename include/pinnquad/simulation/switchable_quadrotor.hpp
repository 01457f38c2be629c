// SPDX-License-Identifier: MIT
// A simulated quadrotor whose ground effect is chosen by a call while it flies, as in the paper's simulator.
// For programs on the ground; what flies has its effects by type.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

/// Of a vehicle that is put together at run time.
enum class GroundEffectModel { none, cheeseman_bennett, conyers };

/// One of three Quadrotors, with `Effects...` and behind them no ground effect, Cheeseman and Bennett's, or Conyers'. A
/// variant of whole vehicles: each choice is the compile-time vehicle to the last bit and at its speed. An effect that
/// held a variant would ask it in each evaluation, and the inverse would solve the coupled equation for `none` too.
template <class... Effects>
class SwitchableQuadrotor {
 public:
  /// Effects as they are by default.
  template <std::size_t Count = sizeof...(Effects), std::enable_if_t<(Count > 0), int> = 0>
  explicit SwitchableQuadrotor(const Airframe<double>& airframe, const Site<double>& site = {})
      : SwitchableQuadrotor(airframe, site, Effects{}...) {}
  template <std::size_t Count = sizeof...(Effects), std::enable_if_t<Count == 0, int> = 0>
  explicit SwitchableQuadrotor(const Airframe<double>& airframe) : SwitchableQuadrotor(airframe, Site<double>{}) {}
  explicit SwitchableQuadrotor(const Airframe<double>& airframe, const Site<double>& site, Effects... effects)
      : airframe_(airframe), site_(site), effects_(effects...), chosen_(Plain(airframe, site, effects...)) {}

  const std::tuple<Effects...>& effects() const noexcept { return effects_; }  ///< without the ground effect
  GroundEffectModel ground_effect() const noexcept { return model_; }

  void set_ground_effect(GroundEffectModel model) {
    std::apply(
        [&](const Effects&... effects) {
          switch (model) {
            case GroundEffectModel::none: chosen_ = Plain(airframe_, site_, effects...); break;
            case GroundEffectModel::cheeseman_bennett:
              chosen_ = With<CheesemanBennettGroundEffect>(airframe_, site_, effects..., {});
              break;
            case GroundEffectModel::conyers:
              chosen_ = With<ConyersGroundEffect>(airframe_, site_, effects..., {});
              break;
          }
        },
        effects_);
    model_ = model;
  }

  /// `function` called with the Quadrotor of the present choice.
  template <class Function>
  decltype(auto) visit(Function&& function) const {
    return std::visit(std::forward<Function>(function), chosen_);
  }

 private:
  using Plain = Quadrotor<double, Effects...>;
  template <class GroundEffect>
  using With = Quadrotor<double, Effects..., GroundEffect>;

  Airframe<double> airframe_;
  Site<double> site_;
  std::tuple<Effects...> effects_;
  std::variant<Plain, With<CheesemanBennettGroundEffect>, With<ConyersGroundEffect>> chosen_;
  GroundEffectModel model_{GroundEffectModel::none};
};

/// A SwitchableQuadrotor as a simulator's vehicle.
template <class Function, class... Effects>
decltype(auto) with_quadrotor(const SwitchableQuadrotor<Effects...>& quadrotor, Function&& function) {
  return quadrotor.visit(std::forward<Function>(function));
}

}  // namespace pinnquad
