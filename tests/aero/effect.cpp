// SPDX-License-Identifier: MIT
#include "pinnquad/aero/effect.hpp"

#include <doctest/doctest.h>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"

namespace {

struct Nothing {};

struct WrongReturnType {
  template <class Scalar>
  Scalar wrench(const pinnquad::AeroCondition<Scalar>&, const pinnquad::Airframe<Scalar>&) const noexcept {
    return Scalar(0);
  }
};

struct NotConst {
  template <class Scalar>
  void surroundings(pinnquad::Surroundings<Scalar>&) noexcept {}
};

struct Both {
  template <class Scalar>
  void surroundings(pinnquad::Surroundings<Scalar>&) const noexcept {}
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>&,
                                  const pinnquad::Airframe<Scalar>&) const noexcept {
    return {};
  }
};

}  // namespace

// who is an effect
static_assert(pinnquad::is_effect<pinnquad::QuadraticDrag>);
static_assert(pinnquad::is_effect<pinnquad::ConstantWind>);
static_assert(pinnquad::is_effect<pinnquad::PeriodicWind>);
static_assert(pinnquad::is_effect<pinnquad::StandardAtmosphere>);
static_assert(pinnquad::is_effect<pinnquad::GroundEffect<pinnquad::Conyers>>);
static_assert(pinnquad::is_effect<Both>);
static_assert(!pinnquad::is_effect<Nothing>);
static_assert(!pinnquad::is_effect<WrongReturnType>);
static_assert(!pinnquad::is_effect<NotConst>);
static_assert(!pinnquad::is_effect<int>);

// which part of the contract an effect fulfils
static_assert(pinnquad::makes_wrench<Both> && pinnquad::changes_surroundings<Both>);
static_assert(pinnquad::makes_wrench<pinnquad::QuadraticDrag> &&
              !pinnquad::changes_surroundings<pinnquad::QuadraticDrag>);
static_assert(!pinnquad::makes_wrench<pinnquad::PeriodicWind> &&
              pinnquad::changes_surroundings<pinnquad::PeriodicWind>);
static_assert(!pinnquad::uses_rotor_wrench<pinnquad::QuadraticDrag>);
static_assert(!pinnquad::uses_rotor_wrench<Both>);
