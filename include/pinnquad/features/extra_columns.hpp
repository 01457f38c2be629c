// SPDX-License-Identifier: MIT
// Anything measured besides the motion as an input of the network: WithColumns<PaperFeatures, BatteryVoltage> is a feature set.
// A column is a type with `name` and `unit`, constexpr texts; flights call their columns by the same names (data/dataset.hpp).
#pragma once

#include <array>
#include <limits>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/features/features.hpp"

namespace pinnquad {

/// Of the pack, under load.
struct BatteryVoltage {
  static constexpr const char* name = "battery_voltage";
  static constexpr const char* unit = "V";
};

/// Of one rotor, as its speed controller reports it. Rotor 1 to 4 in the order of Eq. (2), as u1 to u4.
template <int Rotor>
struct RotorSpeed {
  static_assert(Rotor >= 1 && Rotor <= 4, "pinnquad: rotors count from 1 to 4");
  static constexpr const char* name = Rotor == 1 ? "n1" : Rotor == 2 ? "n2" : Rotor == 3 ? "n3" : "n4";
  static constexpr const char* unit = "rev/s";
};

namespace detail {

/// Two lists of texts, one after the other.
template <std::size_t First, std::size_t Second>
constexpr std::array<const char*, First + Second> joined_texts(const std::array<const char*, First>& first,
                                                               const std::array<const char*, Second>& second) noexcept {
  std::array<const char*, First + Second> result{};
  for (std::size_t i = 0; i < First; ++i) result[i] = first[i];
  for (std::size_t i = 0; i < Second; ++i) result[First + i] = second[i];
  return result;
}

constexpr bool equal_texts(const char* a, const char* b) noexcept {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return *a == *b;
}

template <std::size_t Size>
constexpr bool all_differ(const std::array<const char*, Size>& texts) noexcept {
  for (std::size_t i = 0; i < Size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (equal_texts(texts[i], texts[j])) return false;
    }
  }
  return true;
}

template <class T, class = void>
struct IsColumn : std::false_type {};
template <class T>
struct IsColumn<T, std::void_t<decltype(T::name), decltype(T::unit)>>
    : std::bool_constant<std::is_convertible_v<decltype(T::name), const char*> &&
                         std::is_convertible_v<decltype(T::unit), const char*>> {};

/// Place of a type in a list; the list's length if it isn't there.
template <class Wanted, class... Types>
constexpr std::size_t place_of() noexcept {
  constexpr bool same[] = {std::is_same_v<Wanted, Types>..., true};
  std::size_t place = 0;
  while (!same[place]) ++place;
  return place;
}

/// A feature set with a past (features/windowed.hpp).
template <class Features, class = void>
struct HasWindow : std::false_type {};
template <class Features>
struct HasWindow<Features, std::void_t<typename Features::Window>> : std::true_type {};

template <class Features, class = void>
struct ExtraColumnsOf {
  static constexpr std::array<const char*, 0> names{};
  static constexpr std::array<const char*, 0> units{};
};
template <class Features>
struct ExtraColumnsOf<Features, std::void_t<decltype(Features::column_names), decltype(Features::column_units)>> {
  static constexpr auto names = Features::column_names;
  static constexpr auto units = Features::column_units;
};

}  // namespace detail

/// True for a type that is a column: it has `name` and `unit`.
template <class T>
inline constexpr bool is_column = detail::IsColumn<T>::value;

/// Names and units of the extra columns that a feature set asks for: none but where it is WithColumns, or has one inside.
template <class Features>
inline constexpr auto extra_column_names = detail::ExtraColumnsOf<Features>::names;
template <class Features>
inline constexpr auto extra_column_units = detail::ExtraColumnsOf<Features>::units;

/// The inputs of another feature set and the columns' values. A value that was never set is NaN, which check() refuses.
template <class Base, class Scalar, class... Column>
struct InputsWithColumns : Base {
  /// In the order of the columns.
  std::array<Scalar, sizeof...(Column)> columns = {
      (static_cast<void>(sizeof(Column)), std::numeric_limits<Scalar>::quiet_NaN())...};

  template <class Wanted>
  Scalar& column() noexcept {
    return columns[place<Wanted>()];
  }
  template <class Wanted>
  const Scalar& column() const noexcept {
    return columns[place<Wanted>()];
  }

 private:
  template <class Wanted>
  static constexpr std::size_t place() noexcept {
    constexpr std::size_t found = detail::place_of<Wanted, Column...>();
    static_assert(found < sizeof...(Column), "pinnquad: these inputs have no such column");
    return found;
  }
};

/// A feature set with columns: X of `Features`, then each column as it was measured. A guard's fallback sees the inputs of
/// `Features`.
template <class FeatureSet, class... Column>
struct WithColumns {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: WithColumns' first argument is not a feature set (features/features.hpp)");
  static_assert(
      !detail::HasWindow<FeatureSet>::value,
      "pinnquad: columns belong inside a window, whose history then takes them too: Windowed<WithColumns<...>, ...>");
  static_assert(sizeof...(Column) > 0, "pinnquad: WithColumns needs a column");
  static_assert((is_column<Column> && ...),
                "pinnquad: a column of WithColumns has no name or no unit "
                "(features/extra_columns.hpp)");

  template <class Scalar>
  using Inputs = InputsWithColumns<typename FeatureSet::template Inputs<Scalar>, Scalar, Column...>;

  static constexpr int size = FeatureSet::size + int(sizeof...(Column));
  static constexpr int angular_acceleration = FeatureSet::angular_acceleration;
  static constexpr auto names =
      detail::joined_texts(FeatureSet::names, std::array<const char*, sizeof...(Column)>{Column::name...});
  static constexpr auto units =
      detail::joined_texts(FeatureSet::units, std::array<const char*, sizeof...(Column)>{Column::unit...});
  static_assert(detail::all_differ(names), "pinnquad: a column of WithColumns has a name that is taken");

  /// What flights must have measured: the columns, those of `Features` first.
  static constexpr auto column_names =
      detail::joined_texts(extra_column_names<FeatureSet>, std::array<const char*, sizeof...(Column)>{Column::name...});
  static constexpr auto column_units =
      detail::joined_texts(extra_column_units<FeatureSet>, std::array<const char*, sizeof...(Column)>{Column::unit...});

  /// As `Features`; `not_finite` for a column too.
  template <class Scalar, class Base>
  static Status check(const InputsWithColumns<Base, Scalar, Column...>& in) noexcept {
    return all_finite(in.columns) ? FeatureSet::check(static_cast<const Base&>(in)) : Status::not_finite;
  }

  /// Fills x[0..size). The inputs must have passed check().
  template <class Scalar, class Base>
  static void extract(const InputsWithColumns<Base, Scalar, Column...>& in, Scalar* x) noexcept {
    FeatureSet::extract(static_cast<const Base&>(in), x);
    for (std::size_t i = 0; i < sizeof...(Column); ++i) x[FeatureSet::size + int(i)] = in.columns[i];
  }
};

}  // namespace pinnquad
