// SPDX-License-Identifier: MIT
// Recorded rows as the inputs and the features of a feature set, for training, judgement and export.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/features/input_history.hpp"

namespace pinnquad {

/// Inputs of a row alone: its motion, and its altitude where they have one. Specialised for Inputs of another kind.
template <class Inputs>
Inputs sample_inputs(const Sample& sample) {
  using Scalar = typename decltype(Inputs::body_rates_rad_s)::Scalar;
  constexpr bool with_altitude = std::is_same_v<Inputs, MotionInputsWithAltitude<Scalar>>;
  static_assert(with_altitude || std::is_same_v<Inputs, MotionInputs<Scalar>>,
                "pinnquad: an Inputs struct of your own needs a specialisation of sample_inputs()");
  const Quaternion<double> q = from_euler(EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
  Inputs inputs;
  inputs.linear_acceleration_m_s2 = sample.linear_acceleration_m_s2.cast<Scalar>();
  inputs.angular_acceleration_rad_s2 = sample.angular_acceleration_rad_s2.cast<Scalar>();
  inputs.velocity_m_s = sample.velocity_m_s.cast<Scalar>();
  inputs.body_rates_rad_s = sample.body_rates_rad_s.cast<Scalar>();
  inputs.attitude = {Scalar(q.w), Scalar(q.x), Scalar(q.y), Scalar(q.z)};
  if constexpr (with_altitude) inputs.altitude_m = Scalar(sample.altitude_m);
  return inputs;
}

namespace detail {
/// Commands of any scalar.
template <class Scalar>
Commands<double> in_double(const Commands<Scalar>& commands) {
  Commands<double> result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = static_cast<double>(commands[i]);
  return result;
}
}  // namespace detail

/// Feature vector X of a sample, physical units.
template <class Features, class Scalar>
std::array<Scalar, static_cast<std::size_t>(Features::size)> sample_features(const Sample& sample) {
  std::array<Scalar, static_cast<std::size_t>(Features::size)> x{};
  Features::extract(sample_inputs<typename Features::template Inputs<Scalar>>(sample), x.data());
  return x;
}

/// Reads Inputs from consecutive rows of one flight, and never looks beyond them. Contract of a specialisation: it is
/// made of the rows, and throws std::invalid_argument, one line, for what the flight has not measured. `bool read(row,
/// inputs) const` takes an index of the flight within the rows; where they do not hold what the inputs need, it returns
/// false and writes nothing. This one looks at the row alone, by sample_inputs().
template <class Inputs>
class FlightInputs {
 public:
  explicit FlightInputs(const FlightRows& rows) : flight_(rows.flight) {}

  bool read(std::size_t row, Inputs& inputs) const {
    inputs = sample_inputs<Inputs>((*flight_)[row]);
    return true;
  }

 private:
  const Flight* flight_;
};

namespace detail {
/// Values of a flight's extra column. Throws std::invalid_argument, one line, for one that is absent or in another
/// unit.
inline const std::vector<double>& column_values(const Flight& flight, const std::string& name,
                                                const std::string& unit) {
  const ExtraColumn* column = flight.column(name);
  const std::string expected = "flight '" + flight.name + "': expected a column " + name + " in " + unit + ", found ";
  if (column == nullptr) throw std::invalid_argument(expected + "none of that name");
  if (column->unit != unit) throw std::invalid_argument(expected + "it in " + column->unit);
  return column->values;
}
}  // namespace detail

/// Inputs with extra columns, found by name. Throws std::invalid_argument for one that is absent or in another unit.
template <class Base, class Scalar, class... Column>
class FlightInputs<detail::InputsWithColumns<Base, Scalar, Column...>> {
 public:
  using Inputs = detail::InputsWithColumns<Base, Scalar, Column...>;

  explicit FlightInputs(const FlightRows& rows)
      : base_(rows), columns_{&detail::column_values(*rows.flight, Column::name, Column::unit)...} {}

  bool read(std::size_t row, Inputs& inputs) const {
    Inputs read;
    if (!base_.read(row, read)) return false;
    for (std::size_t i = 0; i < columns_.size(); ++i) read.columns[i] = static_cast<Scalar>((*columns_[i])[row]);
    inputs = read;
    return true;
  }

 private:
  FlightInputs<Base> base_;
  std::array<const std::vector<double>*, sizeof...(Column)> columns_;
};

namespace detail {
/// The other taps of a window about a row, interpolated as in flight (features/input_history.hpp). `read(row, tap)`:
/// the inputs of a row alone. False where a tap lies beyond these rows or behind a gap: no window crosses a border.
template <class Scalar, class Window, class Read, class Tap>
bool read_window(const Window& window, const FlightRows& rows, std::size_t row, const Read& read, Tap* others) {
  const auto time_of = [&rows](std::size_t i) { return (*rows.flight)[i].time_s; };
  const double present_s = time_of(row);
  std::size_t first = row, last = row;
  while (first > rows.rows.begin && time_of(first) > present_s + window.earliest_s &&
         follows(window, time_of(first - 1), time_of(first))) {
    --first;
  }
  while (last + 1 < rows.rows.end && time_of(last) < present_s + window.latest_s &&
         follows(window, time_of(last), time_of(last + 1))) {
    ++last;
  }
  return fill_window<Scalar>(window, present_s, first, last, row, time_of, read, others);
}
}  // namespace detail

/// Windows about a row, which is their present instant. Windows in a row share most of their rows: what was read of one
/// is kept for the next, so one of these is for one thread.
template <class Tap, class Scalar, class Window>
class FlightInputs<detail::WindowInputs<Tap, Scalar, Window>> {
 public:
  using Inputs = detail::WindowInputs<Tap, Scalar, Window>;

  explicit FlightInputs(const FlightRows& rows) : rows_(rows), taps_(rows) {}

  bool read(std::size_t row, Inputs& inputs) const {
    Inputs read;
    if (!taps_.read(row, read)) return false;
    read.complete = detail::read_window<Scalar>(
        Window{}, rows_, row, [this](std::size_t i, Tap& tap) { return read_tap(i, tap); }, read.others.data());
    if (!read.complete) return false;
    inputs = read;
    return true;
  }

 private:
  struct Kept {
    std::size_t row = static_cast<std::size_t>(-1);
    Tap tap{};
  };

  bool read_tap(std::size_t row, Tap& tap) const {
    Kept& kept = kept_[row % kept_.size()];
    if (kept.row != row) {
      if (!taps_.read(row, kept.tap)) return false;
      kept.row = row;
    }
    tap = kept.tap;
    return true;
  }

  FlightRows rows_;
  FlightInputs<Tap> taps_;
  mutable std::vector<Kept> kept_ = std::vector<Kept>(128);
};

/// The extra columns that a feature set needs of a flight: what to ask of read_flight_csv().
template <class Features>
std::vector<ColumnName> wanted_columns() {
  std::vector<ColumnName> wanted;
  for (std::size_t i = 0; i < extra_column_names<Features>.size(); ++i) {
    wanted.push_back({extra_column_names<Features>[i], extra_column_units<Features>[i]});
  }
  return wanted;
}

/// Calls `visit(flight, row, x)` for every row of a set that has features: x in physical units.
template <class Features, class Scalar>
void each_features(
    const RowSet& rows,
    const std::function<void(const Flight&, std::size_t,
                             const std::array<Scalar, static_cast<std::size_t>(Features::size)>&)>& visit) {
  using Inputs = typename Features::template Inputs<Scalar>;
  for (const FlightRows& piece : rows.pieces()) {
    const FlightInputs<Inputs> recorded(piece);
    for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
      Inputs inputs;
      if (!recorded.read(row, inputs)) continue;
      std::array<Scalar, static_cast<std::size_t>(Features::size)> x{};
      Features::extract(inputs, x.data());
      visit(*piece.flight, row, x);
    }
  }
}

}  // namespace pinnquad
