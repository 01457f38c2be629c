// SPDX-License-Identifier: MIT
// Every feature of the library that a motion has, by name, and some of them in an order of one's own: what a network
// that was made elsewhere reads (`pinnquad convert`).
#pragma once

#include "pinnquad/features/motion_parts.hpp"

namespace pinnquad {

/// Every feature of the library that a motion has. A name means the same number in each of its feature sets.
struct NamedFeatures : Joined<PaperFeatures, SpecificForce, RateProducts, DownVector, SquaredVelocity> {};

/// And the altitude.
struct NamedFeaturesWithAltitude : detail::WithAltitude<NamedFeatures> {};

/// The features of `FeatureSet` at these places.
///   Chosen<NamedFeatures, 18, 3, 4, 5>: s_z, wdot_x, wdot_y, wdot_z
template <class FeatureSet, int... Place>
struct Chosen {
  static_assert(is_feature_set<FeatureSet>, "pinnquad: Chosen's first argument is not a feature set");
  static_assert(sizeof...(Place) > 0 && ((Place >= 0 && Place < FeatureSet::size) && ...),
                "pinnquad: Chosen takes places of its feature set, from 0 on");

  template <class Scalar>
  using Inputs = typename FeatureSet::template Inputs<Scalar>;

  static constexpr int size = int(sizeof...(Place));
  /// Place of the first of the three, where all three follow one another; else -1.
  static constexpr int angular_acceleration = [] {
    constexpr int places[] = {Place...};
    for (int i = 0; FeatureSet::angular_acceleration >= 0 && i + 2 < size; ++i) {
      const int first = FeatureSet::angular_acceleration;
      if (places[i] == first && places[i + 1] == first + 1 && places[i + 2] == first + 2) return i;
    }
    return -1;
  }();
  static constexpr std::array<const char*, sizeof...(Place)> names = {FeatureSet::names[std::size_t(Place)]...};
  static constexpr std::array<const char*, sizeof...(Place)> units = {FeatureSet::units[std::size_t(Place)]...};
  static_assert(detail::all_differ(names), "pinnquad: Chosen takes no place twice");
  static_assert(
      [] {
        bool chosen = true;
        for (const std::string_view column : extra_column_names<FeatureSet>) {
          bool found = false;
          for (const char* name : names) found = found || name == column;
          chosen = chosen && found;
        }
        return chosen;
      }(),
      "pinnquad: Chosen leaves out a column that its inputs hold, so that flights would be asked for it in "
      "vain: choose its place, or write WithColumns<Chosen<...>, ...>");

  /// As FeatureSet, of all its inputs.
  template <class AnyInputs>
  static Status check(const AnyInputs& in) noexcept {
    return FeatureSet::check(in);
  }
  /// Fills x[0..size). The inputs must have passed check().
  template <class Scalar, class AnyInputs>
  static void extract(const AnyInputs& in, Scalar* x) noexcept {
    Scalar all[FeatureSet::size];
    FeatureSet::extract(in, static_cast<Scalar*>(all));
    int at = 0;
    ((x[at++] = all[Place]), ...);
  }
};

}  // namespace pinnquad
