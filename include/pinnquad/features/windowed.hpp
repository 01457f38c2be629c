// SPDX-License-Identifier: MIT
// Features with a past: Windowed<PaperFeatures, 4, PeriodMicroseconds<20000>> is a feature set whose X is that of the
// present instant, then those of 20, 40 and 60 ms ago. Taps are at times, not at calls: features/input_history.hpp
// makes such inputs in a control loop, data/flight_features.hpp from recorded flights.
#pragma once

#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/features/features.hpp"

namespace pinnquad {

/// Time between two taps of a window: the sample period of its model.
template <int Microseconds>
struct PeriodMicroseconds {
  static_assert(Microseconds > 0, "pinnquad: a window's period must be 1 us or more");
  static constexpr double seconds = Microseconds / 1e6;
};

/// A window that looks back: for a control loop, which does not know what comes.
struct Causal {
  template <int Taps>
  static constexpr bool fits = Taps >= 1;
  /// In periods from the present, of the tap of this number behind the present one.
  static constexpr int offset(int /*taps*/, int tap) noexcept { return -(tap + 1); }
};

/// A window about its instant, for recorded motions. The earlier taps come first.
struct Centred {
  template <int Taps>
  static constexpr bool fits = Taps >= 1 && Taps % 2 == 1;
  static constexpr int offset(int taps, int tap) noexcept {
    const int half = (taps - 1) / 2;
    return tap < half ? -(tap + 1) : tap - half + 1;
  }
};

namespace detail {

/// The inputs of the present instant, and of the window's other taps. A guard's fallback sees the present alone.
template <class Tap, class Scalar, class Window>
struct WindowInputs : Tap {
  std::array<Tap, static_cast<std::size_t>(Window::taps - 1)> others{};  ///< in the order of Window::offset_s
  bool complete{false};  ///< all taps are set: else check() says `warming_up`
};
template <class Tap, class Scalar, class Window>
struct ColumnsInside<WindowInputs<Tap, Scalar, Window>> : ColumnsInside<Tap> {};

/// The instants of a window.
template <int Taps, class Period, class Reach>
struct TapWindow {
  static constexpr int taps = Taps;  ///< the present one among them
  static constexpr double period_s = Period::seconds;
  static constexpr bool causal = std::is_same_v<Reach, Causal>;
  /// Seconds from the present, of the tap of this number (from 0) behind the present one.
  static constexpr double offset_s(int tap) noexcept { return Reach::offset(Taps, tap) * period_s; }
  static constexpr double earliest_s = causal ? -(Taps - 1) * period_s : -((Taps - 1) / 2) * period_s;
  static constexpr double latest_s = causal ? 0.0 : ((Taps - 1) / 2) * period_s;

  /// Samples further apart than this have a gap between them, over which nothing is interpolated: a missing row is a
  /// gap.
  static constexpr double largest_gap_s = 1.5 * period_s;
  /// A sample this close to a tap is the tap: times are sums of steps, or counts since 1970 in a double.
  static constexpr double tolerance_s = 1e-4 * period_s;
};

template <class FeatureSet, int Offset, int Index>
constexpr std::size_t tap_name_length() noexcept {
  std::size_t letters = 4;  // brackets, sign, end
  for (const char* c = FeatureSet::names[std::size_t(Index)]; *c != '\0'; ++c) ++letters;
  for (int rest = Offset < 0 ? -Offset : Offset; rest > 0; rest /= 10) ++letters;
  return letters;
}

template <class FeatureSet, int Offset, int Index>
constexpr auto make_tap_name() noexcept {
  std::array<char, tap_name_length<FeatureSet, Offset, Index>()> text{};
  std::size_t at = 0;
  for (const char* c = FeatureSet::names[std::size_t(Index)]; *c != '\0'; ++c) text[at++] = *c;
  text[at++] = '[';
  text[at] = Offset < 0 ? '-' : '+';
  std::size_t digit = text.size() - 2;
  text[digit] = ']';
  for (int rest = Offset < 0 ? -Offset : Offset; rest > 0; rest /= 10)
    text[--digit] = static_cast<char>('0' + rest % 10);
  return text;
}

/// "vdot_bx[-2]": the name of a feature of another tap.
template <class FeatureSet, int Offset, int Index>
inline constexpr auto tap_name = make_tap_name<FeatureSet, Offset, Index>();

/// Name of entry `Entry` of a window's X.
template <class FeatureSet, class Part, class Reach, int Taps, int Entry>
constexpr const char* window_name() noexcept {
  if constexpr (Entry < FeatureSet::size) {
    return FeatureSet::names[std::size_t(Entry)];
  } else {
    constexpr int behind = Entry - FeatureSet::size;
    return tap_name<Part, Reach::offset(Taps, behind / Part::size), behind % Part::size>.data();
  }
}
template <class FeatureSet, class Part, class Reach, int Taps, int... Entry>
constexpr std::array<const char*, sizeof...(Entry)> window_names(std::integer_sequence<int, Entry...>) noexcept {
  return {window_name<FeatureSet, Part, Reach, Taps, Entry>()...};
}
template <class FeatureSet, class Part, std::size_t Size>
constexpr std::array<const char*, Size> window_units() noexcept {
  std::array<const char*, Size> units{};
  for (std::size_t i = 0; i < Size; ++i) {
    constexpr std::size_t present = FeatureSet::units.size(), other = Part::units.size();
    units[i] = i < present ? FeatureSet::units[i] : Part::units[(i - present) % other];
  }
  return units;
}

/// X of `FeatureSet` at the present instant, then X of `Part` at each other tap: Windowed and PartlyWindowed.
template <class FeatureSet, class Part, int Taps, class Period, class Reach>
struct WindowFeatures {
  static_assert(is_feature_set<FeatureSet> && is_feature_set<Part>,
                "pinnquad: Windowed's first argument is not a feature set (features/features.hpp)");
  static_assert(!is_windowed<FeatureSet> && !is_windowed<Part>,
                "pinnquad: a window of windows is one with more taps: Windowed has no Windowed inside");
  static_assert(Reach::template fits<Taps>,
                "pinnquad: a window has one tap or more, a centred one an odd number (features/windowed.hpp)");
  static_assert(std::is_base_of_v<typename Part::template Inputs<double>, typename FeatureSet::template Inputs<double>>,
                "pinnquad: the part of PartlyWindowed has the same inputs as its feature set (features/windowed.hpp)");

  using TapFeatures = FeatureSet;
  using OtherTapFeatures = Part;  ///< of the taps behind the present one
  using Window = TapWindow<Taps, Period, Reach>;
  template <class Scalar>
  using Inputs = WindowInputs<typename FeatureSet::template Inputs<Scalar>, Scalar, Window>;

  static constexpr int size = FeatureSet::size + (Taps - 1) * Part::size;
  static constexpr int angular_acceleration = FeatureSet::angular_acceleration;
  static constexpr auto names = window_names<FeatureSet, Part, Reach, Taps>(
      std::make_integer_sequence<int, FeatureSet::size + (Taps - 1) * Part::size>{});
  static constexpr auto units = window_units<FeatureSet, Part, names.size()>();

  /// As `FeatureSet` of the present and as `Part` of every other tap; `warming_up` where a tap is missing and the
  /// present inputs are sound.
  template <class Scalar, class Tap>
  static Status check(const WindowInputs<Tap, Scalar, Window>& in) noexcept {
    const Status present = FeatureSet::check(static_cast<const Tap&>(in));
    if (present != Status::ok) return present;
    if (!in.complete) return Status::warming_up;
    for (const Tap& other : in.others) {
      const Status checked = Part::check(other);
      if (checked != Status::ok) return checked;
    }
    return Status::ok;
  }

  /// Fills x[0..size). The inputs must have passed check(); of a window that is not complete the other taps' features
  /// are NaN.
  template <class Scalar, class Tap>
  static void extract(const WindowInputs<Tap, Scalar, Window>& in, Scalar* x) noexcept {
    FeatureSet::extract(static_cast<const Tap&>(in), x);
    for (std::size_t tap = 0; tap < in.others.size(); ++tap) {
      Scalar* behind = x + FeatureSet::size + int(tap) * Part::size;
      Part::extract(in.others[tap], behind);
      if (in.complete) continue;
      for (int i = 0; i < Part::size; ++i) behind[i] = std::numeric_limits<Scalar>::quiet_NaN();
    }
  }
};

}  // namespace detail

/// A feature set with a window: X of `FeatureSet` at the present instant, then at each other tap, in the order of
/// Window::offset_s: the last instant first.
template <class FeatureSet, int Taps, class Period, class Reach = Causal>
struct Windowed : detail::WindowFeatures<FeatureSet, FeatureSet, Taps, Period, Reach> {};

/// The same with all of `FeatureSet` at the present instant and `Part` of it alone at the other taps: a window over
/// what changes fast. Windowed<Set, ...> is PartlyWindowed<Set, Set, ...>.
template <class FeatureSet, class Part, int Taps, class Period, class Reach = Causal>
struct PartlyWindowed : detail::WindowFeatures<FeatureSet, Part, Taps, Period, Reach> {};

/// Index in X of the angular acceleration at a tap (0: the present one); -1 if it has none there.
template <class Features>
constexpr int angular_acceleration_at([[maybe_unused]] int tap) noexcept {
  if constexpr (is_windowed<Features>) {
    using Part = typename Features::OtherTapFeatures;
    if (tap > 0) {
      return Part::angular_acceleration < 0
                 ? -1
                 : Features::TapFeatures::size + (tap - 1) * Part::size + Part::angular_acceleration;
    }
  }
  return Features::angular_acceleration;
}

}  // namespace pinnquad
