// SPDX-License-Identifier: MIT
// A feature set that is known at run time alone, by the names and units of its features: those of the library are
// worked out from the motion, any other one is a column of the same name. "w_x[-2]" is w_x at another tap of a window.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/features/chosen_features.hpp"
#include "pinnquad/features/input_history.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The texts are read where they stand: they must stay there.
class RunTimeFeatures {
 public:
  static constexpr int most_features = 512;
  static constexpr int most_columns = 32;

  /// A motion as any model may ask for it.
  template <class Scalar>
  struct Inputs : MotionInputsWithAltitude<Scalar> {
    std::array<Scalar, most_columns> columns{};  ///< in the order of column()
  };

  /// The instants of a window, as detail::TapWindow.
  struct Window {
    static constexpr int most_taps = 64;

    int taps = 1;
    bool causal = true;
    double period_s = 0;
    double earliest_s = 0, latest_s = 0, largest_gap_s = 0, tolerance_s = 0;

    Window() noexcept = default;
    Window(int taps_, bool causal_, double period_s_) noexcept
        : taps(taps_),
          causal(causal_),
          period_s(period_s_),
          earliest_s(causal_ ? -(taps_ - 1) * period_s_ : -((taps_ - 1) / 2) * period_s_),
          latest_s(causal_ ? 0.0 : ((taps_ - 1) / 2) * period_s_),
          largest_gap_s(1.5 * period_s_),
          tolerance_s(1e-4 * period_s_) {}

    /// In periods from the present, of the tap of this number behind the present one.
    int offset(int tap) const noexcept { return causal ? Causal::offset(taps, tap) : Centred::offset(taps, tap); }
    double offset_s(int tap) const noexcept { return offset(tap) * period_s; }
  };

  /// `texts`: name and unit of each feature, every one closed by a 0. False for texts that are no such list, a tap that
  /// the window has not or that no feature is of, a name of the library with another unit, a name that stands twice,
  /// and for more columns or features than there is room for.
  bool read(std::string_view texts, int count, const Window& window) noexcept {
    if (count < 1 || count > most_features || window.taps < 1 || window.taps > Window::most_taps) return false;
    window_ = window;
    size_ = count;
    column_count_ = 0;
    for (int i = 0; i < count; ++i) {
      Feature& feature = features_[i];
      if (!take_text(texts, feature.named.name) || !take_text(texts, feature.named.unit)) return false;
      if (feature.named.name.empty() || !find(feature)) return false;
      for (int k = 0; k < i; ++k) {
        if (features_[k].source == feature.source && features_[k].tap == feature.tap) return false;
      }
    }
    return texts.empty() && uses_its_window();
  }
  /// Takes the text before the next 0. False where there is none.
  static bool take_text(std::string_view& texts, std::string_view& text) noexcept {
    const std::size_t end = texts.find('\0');
    if (end == std::string_view::npos) return false;
    text = {texts.data(), end};  // substr() is not noexcept
    texts.remove_prefix(end + 1);
    return true;
  }

  int size() const noexcept { return size_; }
  const detail::NameAndUnit& operator[](int feature) const noexcept { return features_[feature].named; }
  const Window& window() const noexcept { return window_; }
  /// Columns that it asks for, in the order of Inputs::columns.
  int column_count() const noexcept { return column_count_; }
  const detail::NameAndUnit& column(int index) const noexcept { return columns_[index]; }
  bool is_column(int feature) const noexcept { return features_[feature].source > altitude; }
  bool asks_for_altitude() const noexcept {
    for (int i = 0; i < size_; ++i) {
      if (features_[i].source == altitude) return true;
    }
    return false;
  }
  /// Place of the angular acceleration about x at a tap, 0 the present one; -1 without its three.
  int angular_acceleration(int tap) const noexcept {
    for (int i = 0; i + 2 < size_; ++i) {
      const bool three = features_[i].tap == tap && features_[i].source == PaperFeatures::angular_acceleration &&
                         features_[i + 1].source == features_[i].source + 1 &&
                         features_[i + 2].source == features_[i].source + 2;
      if (three) return i;
    }
    return -1;
  }

  /// `inputs`: of each tap, the present one first. The first Status that is not ok: of the motion of every tap that is
  /// asked for something; `not_finite` for the altitude and columns that are asked for.
  template <class Scalar>
  Status check(const Inputs<Scalar>* inputs) const noexcept {
    for (int tap = 0; tap < window_.taps; ++tap) {
      const Status checked = check_tap(inputs[tap], tap);
      if (checked != Status::ok) return checked;
    }
    return Status::ok;
  }
  /// Checks the present instant alone: a window may still lack its past.
  template <class Scalar>
  Status check_present(const Inputs<Scalar>& inputs) const noexcept {
    return check_tap(inputs, 0);
  }
  /// Fills x[0..size()), physical units.
  template <class Scalar>
  void extract(const Inputs<Scalar>* inputs, Scalar* x) const noexcept {
    for (int tap = 0; tap < window_.taps; ++tap) extract_tap(inputs[tap], tap, x);
  }
  /// The features of one tap among them.
  template <class Scalar>
  void extract_tap(const Inputs<Scalar>& inputs, int tap, Scalar* x) const noexcept {
    Scalar named[NamedFeatures::size];
    NamedFeatures::extract(static_cast<const MotionInputs<Scalar>&>(inputs), static_cast<Scalar*>(named));
    for (int i = 0; i < size_; ++i) {
      const int source = features_[i].source;
      if (features_[i].tap == tap) x[i] = source < altitude ? named[source] : beside_motion(inputs, source);
    }
  }

 private:
  template <class Scalar>
  Status check_tap(const Inputs<Scalar>& inputs, int tap) const noexcept {
    bool finite = true;
    for (int i = 0; i < size_; ++i) {
      if (features_[i].tap != tap || features_[i].source < altitude) continue;
      finite &= is_finite(beside_motion(inputs, features_[i].source));
    }
    return finite ? PaperFeatures::check<Scalar>(inputs) : Status::not_finite;
  }

  static constexpr int altitude = NamedFeatures::size;  ///< columns come behind it

  struct Feature {
    detail::NameAndUnit named;
    int source = 0;
    int tap = 0;
  };

  template <class Scalar>
  static const Scalar& beside_motion(const Inputs<Scalar>& inputs, int source) noexcept {
    return source == altitude ? inputs.altitude_m : inputs.columns[std::size_t(source - altitude - 1)];
  }

  bool uses_its_window() const noexcept {
    bool used[Window::most_taps] = {};
    int taps = 0;
    for (int i = 0; i < size_; ++i) {
      bool& of_tap = used[features_[i].tap];
      taps += of_tap ? 0 : 1;
      of_tap = true;
    }
    return taps == window_.taps;
  }

  bool find(Feature& feature) noexcept {
    std::string_view name = feature.named.name;
    feature.tap = 0;
    if (name.back() == ']' && !find_tap(name, feature.tap)) return false;
    for (int i = 0; i < NamedFeatures::size; ++i) {
      if (name != NamedFeatures::names[std::size_t(i)]) continue;
      feature.source = i;
      return feature.named.unit == NamedFeatures::units[std::size_t(i)];
    }
    if (name == "altitude") {
      feature.source = altitude;
      return feature.named.unit == "m";
    }
    int column = 0;
    while (column < column_count_ && columns_[column].name != name) ++column;
    if (column == most_columns) return false;
    if (column == column_count_) columns_[column_count_++] = {name, feature.named.unit};
    feature.source = altitude + 1 + column;
    return columns_[column].unit == feature.named.unit;
  }

  /// "name[-2]" becomes "name" and the number of the tap.
  bool find_tap(std::string_view& name, int& tap) const noexcept {
    const std::size_t bracket = name.rfind('[');
    if (bracket == std::string_view::npos || bracket == 0 || bracket + 3 > name.size()) return false;
    const std::string_view digits(name.data() + bracket + 2, name.size() - bracket - 3);
    const char sign = name[bracket + 1];
    int periods = 0;
    for (const char digit : digits) {
      if (digit < '0' || digit > '9' || periods > Window::most_taps) return false;
      periods = 10 * periods + (digit - '0');
    }
    if ((sign != '-' && sign != '+') || digits.empty()) return false;
    name = {name.data(), bracket};
    for (int other = 0; other < window_.taps - 1; ++other) {
      if (window_.offset(other) != (sign == '-' ? -periods : periods)) continue;
      tap = other + 1;
      return true;
    }
    return false;
  }

  Feature features_[most_features];
  detail::NameAndUnit columns_[most_columns];
  Window window_;
  int size_ = 0;
  int column_count_ = 0;
};

/// As of motions; columns linearly.
template <class Scalar>
RunTimeFeatures::Inputs<Scalar> interpolated(const RunTimeFeatures::Inputs<Scalar>& a,
                                             const RunTimeFeatures::Inputs<Scalar>& b, Scalar share) noexcept {
  using Motion = MotionInputsWithAltitude<Scalar>;
  RunTimeFeatures::Inputs<Scalar> result;
  static_cast<Motion&>(result) = interpolated(static_cast<const Motion&>(a), static_cast<const Motion&>(b), share);
  for (std::size_t i = 0; i < result.columns.size(); ++i) {
    result.columns[i] = a.columns[i] + share * (b.columns[i] - a.columns[i]);
  }
  return result;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
