// SPDX-License-Identifier: MIT
// The distance of a feature vector from the training rows, all features taken together (Mahalanobis). A motion is far
// whose features are each within what was flown and never came together.
//   squared distance = |W (x - mean)|^2,  W' W = inverse of the rows' covariance (training/structured/trust_limits.hpp)
// docs/trust.md says what it finds and what it does not.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/exported/model_records.hpp"

namespace pinnquad {

/// Policy of a Guard: the squared distance of the features that the network is asked with is at most
/// `Distribution::squared_distance_limit`, else `outside_distribution`. size (size + 1) / 2 multiply-adds.
/// Contract of a Distribution, a struct of constants that deploy/trust_writer.hpp writes beside the model:
///   array distribution_mean: size numbers, physical units
///   array whitening: size (size + 1) / 2 numbers, W, lower triangular, column after column from its diagonal down
///   double squared_distance_limit
///   optional std::uint64_t training_data_hash, that of the model
/// On the ground they may be static members that change at run time; nothing of them is checked while compiling then.
template <class Distribution>
struct JointDistance {};

namespace detail {

template <class Distribution>
using DistributionMembers = std::void_t<decltype(Distribution::distribution_mean), decltype(Distribution::whitening),
                                        decltype(double{Distribution::squared_distance_limit})>;
template <class Distribution>
using ConstantDistanceLimit = std::bool_constant<(Distribution::squared_distance_limit > 0)>;
/// Detects a hash that is a static member: a block's model has its hash at run time.
template <class T>
using StaticTrainingDataHash = std::enable_if_t<std::is_pointer_v<decltype(&T::training_data_hash)>>;

/// A positive number, where it is a constant.
template <class Distribution>
constexpr bool sound_distance_limit() noexcept {
  if constexpr (is_detected<ConstantDistanceLimit, Distribution>) {
    return is_finite_constant(double(Distribution::squared_distance_limit)) && Distribution::squared_distance_limit > 0;
  } else {
    return true;
  }
}

/// Checks that a distribution is one, and the model's.
template <class Distribution, class Model>
constexpr bool require_distribution() noexcept {
  static_assert(is_detected<DistributionMembers, Distribution>,
                "pinnquad: a JointDistance needs distribution_mean, whitening and squared_distance_limit "
                "(inference/joint_distance.hpp)");
  if constexpr (is_detected<DistributionMembers, Distribution>) {
    constexpr auto size = static_cast<std::size_t>(Model::Features::size);
    static_assert(
        Distribution::distribution_mean.size() == size && Distribution::whitening.size() == size * (size + 1) / 2,
        "pinnquad: the distribution of a JointDistance has another size than the model's features");
    static_assert(std::is_same_v<std::decay_t<decltype(Distribution::distribution_mean[0])>, typename Model::Scalar> &&
                      std::is_same_v<std::decay_t<decltype(Distribution::whitening[0])>, typename Model::Scalar>,
                  "pinnquad: the distribution of a JointDistance has another Scalar than the model");
    if constexpr (is_detected<ConstantDistanceLimit, Distribution>) {
      static_assert(
          all_finite_constants(Distribution::distribution_mean) && all_finite_constants(Distribution::whitening),
          "pinnquad: a number of the distribution of a JointDistance is NaN or infinite");
    }
    if constexpr (is_detected<StaticTrainingDataHash, Distribution> && is_detected<StaticTrainingDataHash, Model>) {
      static_assert(Distribution::training_data_hash == Model::training_data_hash,
                    "pinnquad: the distribution of a JointDistance is that of other training data than the model's");
    }
  }
  return true;
}

}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// |W (x - mean)|^2 of features in physical units; not finite where x is not, or where a square overflows.
template <class Distribution, class Scalar>
PINNQUAD_NOINLINE Scalar squared_joint_distance(const Scalar* x) noexcept {
  constexpr int size = static_cast<int>(Distribution::distribution_mean.size());
  constexpr const Scalar* mean = Distribution::distribution_mean.data();
  constexpr const Scalar* whitening = Distribution::whitening.data();
  Scalar white[static_cast<std::size_t>(size)] = {};
  const Scalar* column = whitening;
  for (int j = 0; j < size; ++j) {
    const Scalar difference = x[j] - mean[j];
    for (int i = j; i < size; ++i) white[i] += column[i - j] * difference;
    column += size - j;
  }
  Scalar squared(0);
  for (int i = 0; i < size; ++i) squared += white[i] * white[i];
  return squared;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
