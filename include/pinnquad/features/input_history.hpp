// SPDX-License-Identifier: MIT
// Inputs of a feature set in a control loop: the present ones, or a window of them at exact distances in time whatever
// the loop's jitter. A value without heap.
#pragma once

#include <cmath>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/features/windowed.hpp"

namespace pinnquad {

/// Inputs between two samples, `share` from 0 (a) to 1 (b), the same in flight and in training. Straight lines; the
/// attitude by the normalised straight line between the quaternions, the shorter way: over 0.25 rad of a turn at
/// constant rate it errs by 6e-5 rad, over 0.5 rad by 5e-4 rad. For inputs of your own write an `interpolated` in their
/// namespace.
template <class Scalar>
MotionInputs<Scalar> interpolated(const MotionInputs<Scalar>& a, const MotionInputs<Scalar>& b, Scalar share) noexcept {
  MotionInputs<Scalar> result;
  result.linear_acceleration_m_s2 =
      a.linear_acceleration_m_s2 + share * (b.linear_acceleration_m_s2 - a.linear_acceleration_m_s2);
  result.angular_acceleration_rad_s2 =
      a.angular_acceleration_rad_s2 + share * (b.angular_acceleration_rad_s2 - a.angular_acceleration_rad_s2);
  result.velocity_m_s = a.velocity_m_s + share * (b.velocity_m_s - a.velocity_m_s);
  result.body_rates_rad_s = a.body_rates_rad_s + share * (b.body_rates_rad_s - a.body_rates_rad_s);
  const Quaternion<Scalar>& p = a.attitude;
  const Quaternion<Scalar>& q = b.attitude;
  const Scalar cosine = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;  // of half the turn
  const Scalar of_a = Scalar(1) - share, of_b = cosine < Scalar(0) ? -share : share;
  result.attitude = normalized(Quaternion<Scalar>{of_a * p.w + of_b * q.w, of_a * p.x + of_b * q.x,
                                                  of_a * p.y + of_b * q.y, of_a * p.z + of_b * q.z});
  return result;
}

/// The altitude linearly too.
template <class Scalar>
MotionInputsWithAltitude<Scalar> interpolated(const MotionInputsWithAltitude<Scalar>& a,
                                              const MotionInputsWithAltitude<Scalar>& b, Scalar share) noexcept {
  MotionInputsWithAltitude<Scalar> result;
  static_cast<MotionInputs<Scalar>&>(result) =
      interpolated(static_cast<const MotionInputs<Scalar>&>(a), static_cast<const MotionInputs<Scalar>&>(b), share);
  result.altitude_m = a.altitude_m + share * (b.altitude_m - a.altitude_m);
  return result;
}

namespace detail {

template <class Base, class Scalar, class... Column>
InputsWithColumns<Base, Scalar, Column...> interpolated(const InputsWithColumns<Base, Scalar, Column...>& a,
                                                        const InputsWithColumns<Base, Scalar, Column...>& b,
                                                        Scalar share) noexcept {
  InputsWithColumns<Base, Scalar, Column...> result;
  static_cast<Base&>(result) = interpolated(static_cast<const Base&>(a), static_cast<const Base&>(b), share);
  for (std::size_t i = 0; i < result.columns.size(); ++i) {
    result.columns[i] = a.columns[i] + share * (b.columns[i] - a.columns[i]);
  }
  return result;
}

/// Inputs at an instant among samples `first` to `last`, whose times rise; the search begins at `at`, which is left
/// where it ended: near the next tap. A sample within the window's tolerance is taken as it is. False before the first
/// and behind the last sample. `window`: a TapWindow, or one that is known at run time alone.
template <class Scalar, class Window, class Index, class TimeOf, class Read, class Tap>
bool read_at(const Window& window, double time_s, Index first, Index last, Index& at, const TimeOf& time_of,
             const Read& read, Tap& result) noexcept {
  const double until_s = time_s + window.tolerance_s;
  while (at > first && time_of(at) > until_s) --at;
  while (at < last && time_of(at + 1) <= until_s) ++at;
  const double behind_s = time_s - time_of(at);
  if (behind_s < -window.tolerance_s) return false;
  if (behind_s <= window.tolerance_s) return read(at, result);
  if (at == last) return false;
  Tap before, after;
  if (!read(at, before) || !read(at + 1, after)) return false;
  const double share = behind_s / (time_of(at + 1) - time_of(at));
  result = interpolated(before, after, static_cast<Scalar>(share));
  return true;
}

/// Fills the other taps of a window about a present instant. False where one of them is not there.
template <class Scalar, class Window, class Index, class TimeOf, class Read, class Tap>
bool fill_window(const Window& window, double present_s, Index first, Index last, Index near, const TimeOf& time_of,
                 const Read& read, Tap* others) noexcept {
  bool complete = true;
  for (int tap = 0; tap < window.taps - 1; ++tap) {
    const double time_s = present_s + window.offset_s(tap);
    complete &= read_at<Scalar>(window, time_s, first, last, near, time_of, read, others[tap]);
  }
  return complete;
}

/// True for two samples that are neighbours to a window: later, and not by more than a gap.
template <class Window>
constexpr bool follows(const Window& window, double earlier_s, double later_s) noexcept {
  return later_s > earlier_s && later_s - earlier_s <= window.largest_gap_s + window.tolerance_s;
}

/// Inputs of an instant.
template <class Inputs>
struct TimedInputs {
  double time_s;
  Inputs inputs;
};

/// The last inputs of a loop, as many as a causal window asks for. `Samples`: room for four TimedInputs or more.
/// `Window`: a TapWindow, or one that is known at run time alone.
template <class Scalar, class Window, class Samples>
class PastInputs {
 public:
  PastInputs() = default;
  PastInputs(const Window& window, const Samples& samples) : window_(window), samples_(samples) {}

  /// Takes the present inputs, sound ones of a finite time, and fills the window's other taps. False where it is not
  /// complete.
  template <class Inputs>
  bool take(const Inputs& present, double time_s, Inputs* others) noexcept {
    if (count_ > 0) {
      const double newest_s = sample(count_ - 1).time_s;
      if (equal(time_s, newest_s)) {
        --count_;
      } else if (!follows(window_, newest_s, time_s)) {
        count_ = 0;
      } else if (count_ > 1 && newest_s - sample(count_ - 2).time_s < thinned_s() &&
                 (!keeps_neighbours() || follows(window_, sample(count_ - 2).time_s, time_s))) {
        --count_;  // the present one takes the place of one that was kept as the newest alone
      }
    }
    sample(count_) = {time_s, present};
    ++count_;
    while (count_ > 1 && sample(1).time_s <= time_s + window_.earliest_s + window_.tolerance_s) {
      oldest_ = (oldest_ + 1) % size();
      --count_;
    }
    return fill_window<Scalar>(
        window_, time_s, 0, count_ - 1, count_ - 1, [this](int i) noexcept { return sample(i).time_s; },
        [this](int i, Inputs& result) noexcept {
          result = sample(i).inputs;
          return true;
        },
        others);
  }

  void clear() noexcept { count_ = 0; }

 private:
  int size() const noexcept { return static_cast<int>(samples_.size()); }
  /// Samples closer than this are thinned: so many fit into the window that its oldest neighbour and the newest have
  /// room too.
  double thinned_s() const noexcept { return -window_.earliest_s / (size() - 3); }
  /// True where thinning must leave no gap. A sample that stays before a late tick takes no more room, since the two
  /// steps together are as long as two that thinning leaves. A shorter history has no room for that.
  bool keeps_neighbours() const noexcept { return 2 * thinned_s() <= window_.largest_gap_s; }

  /// Counted from the oldest.
  auto& sample(int i) noexcept { return samples_[std::size_t((oldest_ + i) % size())]; }

  Window window_{};
  Samples samples_{};
  int oldest_{0};
  int count_{0};
};

/// Samples that a history keeps by default: eight per period of the window. Those of a faster loop are thinned to that.
constexpr int history_length(int taps) noexcept { return 8 * (taps - 1) + 4; }

}  // namespace detail

/// History length that a feature set needs.
template <class Features>
constexpr int default_history_length() noexcept {
  if constexpr (is_windowed<Features>) {
    return detail::history_length(Features::Window::taps);
  } else {
    return 0;
  }
}

/// Without a window: the present inputs, always `ok`; predict() checks them.
template <class Features, class Scalar, int MostSamples = default_history_length<Features>(), class = void>
class InputHistory {
 public:
  using Inputs = typename Features::template Inputs<Scalar>;
  using Present = Inputs;

  Status take(const Present& present, double /*time_s*/) noexcept {
    inputs_ = present;
    return Status::ok;
  }
  const Inputs& inputs() const noexcept { return inputs_; }
  /// In the place of inputs(), until the next take(): a reference to `present` would outlive a temporary one.
  const Inputs& lasting(const Present& present) noexcept {
    inputs_ = present;
    return inputs_;
  }
  void clear() noexcept {}

 private:
  Inputs inputs_{};
};

/// History of a causal window. Take the present inputs with their time in every tick; taps in between are interpolated.
template <class Features, class Scalar, int MostSamples>
class InputHistory<Features, Scalar, MostSamples, std::enable_if_t<is_windowed<Features>>> {
  using FeatureSet = typename Features::TapFeatures;
  using Window = typename Features::Window;
  static_assert(Window::causal, "pinnquad: a centred window looks ahead, and no loop can (features/windowed.hpp)");
  static_assert(MostSamples >= 4, "pinnquad: an InputHistory keeps four samples or more");

 public:
  using Inputs = typename Features::template Inputs<Scalar>;
  using Present = typename FeatureSet::template Inputs<Scalar>;

  /// The present inputs; time in seconds from any start. `ok`: the window is complete. `warming_up`: not yet, since the
  /// start, a gap of more than Window::largest_gap_s, or time that ran backwards, which empty the history. `not_finite`
  /// for the time, or any Status of the feature set for refused inputs: the history stays as it was. The same time
  /// again replaces the sample.
  Status take(const Present& present, double time_s) noexcept {
    static_cast<Present&>(inputs_) = present;
    inputs_.complete = false;
    if (!is_finite(time_s)) return Status::not_finite;
    const Status checked = FeatureSet::check(present);
    if (checked != Status::ok) return checked;
    inputs_.complete = past_.take(present, time_s, inputs_.others.data());
    return inputs_.complete ? Status::ok : Status::warming_up;
  }

  /// As of the last take(): the present inputs, and the window's taps where it was `ok`.
  const Inputs& inputs() const noexcept { return inputs_; }

  /// The inputs of a motion that has lasted as long as the window: in the place of inputs(), until the next take().
  const Inputs& lasting(const Present& present) noexcept {
    static_cast<Present&>(inputs_) = present;
    inputs_.others.fill(present);
    inputs_.complete = true;
    return inputs_;
  }

  /// Forgets the past, as after a controller was switched off.
  void clear() noexcept {
    past_.clear();
    inputs_.complete = false;
  }

 private:
  using Samples = std::array<detail::TimedInputs<Present>, std::size_t(MostSamples)>;

  detail::PastInputs<Scalar, Window, Samples> past_{};
  Inputs inputs_{};
};

}  // namespace pinnquad
