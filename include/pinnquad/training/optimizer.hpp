// SPDX-License-Identifier: MIT
// The contract of an optimiser: `Step begin(long step) const` once per batch (steps from 1), then per layer
//   template <class Pack> void update(const Step&, Scalar* parameters, const Scalar* gradient, Scalar* first, Scalar* second,
//                                     int count) const noexcept;
// on whole packs; `first` and `second` are the optimiser's to keep. One that needs to know how far training is takes
// `begin(long step, double done)` instead, done = share of all steps taken before this one, 0 <= done < 1.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/nn/kernel/pack_generic.hpp"

namespace pinnquad {

namespace detail {
template <class T, class = void>
struct FollowsProgress : std::false_type {};
template <class T>
struct FollowsProgress<T, std::void_t<decltype(std::declval<const T&>().begin(1L, 0.0))>> : std::true_type {};

template <class T, class = void>
struct BeginsStep {
  using Step = void;
};
template <class T>
struct BeginsStep<T, std::enable_if_t<FollowsProgress<T>::value>> {
  using Step = decltype(std::declval<const T&>().begin(1L, 0.0));
};
template <class T>
struct BeginsStep<
    T, std::enable_if_t<!FollowsProgress<T>::value, std::void_t<decltype(std::declval<const T&>().begin(1L))>>> {
  using Step = decltype(std::declval<const T&>().begin(1L));
};

template <class T, class Step, class = void>
struct UpdatesParameters : std::false_type {};
template <class T, class Step>
struct UpdatesParameters<
    T, Step,
    std::void_t<decltype(std::declval<const T&>().template update<GenericPack<double, 4>>(
        std::declval<const Step&>(), static_cast<double*>(nullptr), static_cast<const double*>(nullptr),
        static_cast<double*>(nullptr), static_cast<double*>(nullptr), 4))>>
    : std::bool_constant<noexcept(std::declval<const T&>().template update<GenericPack<double, 4>>(
          std::declval<const Step&>(), static_cast<double*>(nullptr), static_cast<const double*>(nullptr),
          static_cast<double*>(nullptr), static_cast<double*>(nullptr), 4))> {};
}  // namespace detail

/// True for an optimiser whose begin() is told how far training is.
template <class T>
inline constexpr bool follows_progress = detail::FollowsProgress<T>::value;

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_optimizer = detail::UpdatesParameters<T, typename detail::BeginsStep<T>::Step>::value;

}  // namespace pinnquad
