// SPDX-License-Identifier: MIT
// Further measured values as inputs of the network: WithColumns<PaperFeatures, BatteryVoltage> is a feature set. A
// column is a type with `name` and `unit`, constexpr texts; flights call their columns by the same names
// (data/dataset.hpp).
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/features/features.hpp"

namespace pinnquad {

/// Voltage of the pack, under load. A column of your own is written the same way, in a file that flight code includes
/// before the exported header, which names it.
struct BatteryVoltage {
  static constexpr const char* name = "battery_voltage";
  static constexpr const char* unit = "V";
};

namespace detail {

template <class T>
using ColumnMembers = std::enable_if_t<std::is_convertible_v<decltype(T::name), const char*> &&
                                       std::is_convertible_v<decltype(T::unit), const char*>>;
template <class T>
using MeasuredColumnsOf = std::void_t<decltype(T::column_names), decltype(T::column_units)>;
/// Columns that inputs hold.
template <class Inputs>
struct ColumnsInside {
  static constexpr std::array<const char*, 0> names{}, units{};
};
template <class Features>
constexpr auto extra_columns_of(bool units) noexcept {
  if constexpr (is_detected<MeasuredColumnsOf, Features>) {
    return units ? Features::column_units : Features::column_names;
  } else {
    using Columns = ColumnsInside<typename Features::template Inputs<double>>;
    return units ? Columns::units : Columns::names;
  }
}

}  // namespace detail

/// Names and units of the columns that a feature set asks for: all that its inputs hold, or those that it names
/// (`column_names`, `column_units`) where its inputs are of another type. set_columns() sets them in this order.
template <class Features>
inline constexpr auto extra_column_names = detail::extra_columns_of<Features>(false);
template <class Features>
inline constexpr auto extra_column_units = detail::extra_columns_of<Features>(true);

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

constexpr bool same_start(std::string_view text, std::string_view start) noexcept {
  bool same = text.size() >= start.size();
  for (std::size_t i = 0; same && i < start.size(); ++i) same = text[i] == start[i];
  return same;
}

template <class Features>
struct ColumnPlaces {
  bool at[std::size_t(Features::size)] = {};  // no std::array: unoptimised code would call it
};
template <class Features>
constexpr ColumnPlaces<Features> find_columns() noexcept {
  ColumnPlaces<Features> found{};
  for (const std::string_view column : extra_column_names<Features>) {
    for (std::size_t i = 0; i < std::size_t(Features::size); ++i) {
      const std::string_view name = Features::names[i];
      const bool ends = name.size() == column.size() || (name.size() > column.size() && name[column.size()] == '[');
      found.at[i] = found.at[i] || (ends && same_start(name, column));
    }
  }
  return found;
}
template <class Features>
inline constexpr ColumnPlaces<Features> column_places = find_columns<Features>();

/// True of an entry of X that is a column, at whatever tap of a window.
template <class Features>
constexpr bool is_column([[maybe_unused]] int place) noexcept {
  if constexpr (extra_column_names<Features>.size() == 0) {
    return false;
  } else {
    return column_places<Features>.at[place];
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET

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
    static_assert((std::is_same_v<Wanted, Column> || ...), "pinnquad: these inputs have no such column");
    constexpr bool same[] = {std::is_same_v<Wanted, Column>..., true};
    std::size_t at = 0;
    while (!same[at]) ++at;
    return at;
  }
};

template <class Base, class Scalar, class... Column>
struct ColumnsInside<InputsWithColumns<Base, Scalar, Column...>> {
  using Texts = std::array<const char*, sizeof...(Column)>;
  static constexpr auto names = joined_texts(ColumnsInside<Base>::names, Texts{Column::name...});
  static constexpr auto units = joined_texts(ColumnsInside<Base>::units, Texts{Column::unit...});
};
}  // namespace detail

/// Sets every column of a model's inputs, from `values` in the order of extra_column_names; what follows is returned.
/// Inputs without a column stay as they are.
template <class Scalar>
const Scalar* set_columns(MotionInputs<Scalar>& /*inputs*/, const Scalar* values) noexcept {
  return values;
}
/// Sets the columns of inputs that have some.
template <class Base, class Scalar, class... Column>
const Scalar* set_columns(detail::InputsWithColumns<Base, Scalar, Column...>& inputs, const Scalar* values) noexcept {
  values = set_columns(static_cast<Base&>(inputs), values);
  for (Scalar& column : inputs.columns) column = *values++;
  return values;
}

/// A feature set with columns: X of `FeatureSet`, then each column as it was measured. A guard's fallback sees the
/// inputs of `FeatureSet`.
template <class FeatureSet, class... Column>
struct WithColumns {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: WithColumns' first argument is not a feature set (features/features.hpp)");
  static_assert(
      !is_windowed<FeatureSet>,
      "pinnquad: columns belong inside a window, whose history then takes them too: Windowed<WithColumns<...>, ...>");
  static_assert(sizeof...(Column) > 0, "pinnquad: WithColumns needs a column");
  static_assert((is_detected<detail::ColumnMembers, Column> && ...),
                "pinnquad: a column of WithColumns has no name or no unit (features/extra_columns.hpp)");

  template <class Scalar>
  using Inputs = detail::InputsWithColumns<typename FeatureSet::template Inputs<Scalar>, Scalar, Column...>;

  static constexpr int size = FeatureSet::size + int(sizeof...(Column));
  using Texts = std::array<const char*, sizeof...(Column)>;
  static constexpr int angular_acceleration = FeatureSet::angular_acceleration;
  static constexpr auto names = detail::joined_texts(FeatureSet::names, Texts{Column::name...});
  static constexpr auto units = detail::joined_texts(FeatureSet::units, Texts{Column::unit...});
  static_assert(detail::all_differ(names), "pinnquad: a column of WithColumns has a name that is taken");

  /// As `FeatureSet`; `not_finite` for a column too.
  template <class Scalar, class Base>
  static Status check(const detail::InputsWithColumns<Base, Scalar, Column...>& in) noexcept {
    return all_finite(in.columns) ? FeatureSet::check(static_cast<const Base&>(in)) : Status::not_finite;
  }

  /// Fills x[0..size). The inputs must have passed check().
  template <class Scalar, class Base>
  static void extract(const detail::InputsWithColumns<Base, Scalar, Column...>& in, Scalar* x) noexcept {
    FeatureSet::extract(static_cast<const Base&>(in), x);
    for (std::size_t i = 0; i < sizeof...(Column); ++i) x[FeatureSet::size + int(i)] = in.columns[i];
  }
};

}  // namespace pinnquad
