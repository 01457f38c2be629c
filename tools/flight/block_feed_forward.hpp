// SPDX-License-Identifier: MIT
// A model of a block as feed-forward: NetworkInverse, with the window and the columns that the block asks for. It
// answers as the compiled model would, to the bit of the portable kernel, behind the guard that is given.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "flight/run_time_view.hpp"
#include "pinnquad/control/feed_forward.hpp"

namespace pinnquad {

/// Of features that are known at run time alone, with a window that looks back or with none.
template <int Most, class Scalar, int MostSamples>
class InputHistory<programs::FlightFeatures<Most>, Scalar, MostSamples, void> {
 public:
  using Inputs = programs::FlightInputs<Scalar>;
  using Present = RunTimeFeatures::Inputs<Scalar>;

  /// The features must stay where they are.
  explicit InputHistory(const RunTimeFeatures& features)
      : past_(features.window(), Samples(std::size_t(detail::history_length(features.window().taps)))) {
    inputs_.features = &features;
    inputs_.taps.resize(std::size_t(features.window().taps));
  }

  /// As that of a windowed feature set.
  Status take(const Present& present, double time_s) noexcept {
    static_cast<MotionInputsWithAltitude<Scalar>&>(inputs_) = present;
    inputs_.taps.front() = present;
    inputs_.complete = false;
    if (!is_finite(time_s)) return Status::not_finite;
    const Status checked = inputs_.features->check_present(present);
    if (checked != Status::ok) return checked;
    inputs_.complete = past_.take(present, time_s, inputs_.taps.data() + 1);
    return inputs_.complete ? Status::ok : Status::warming_up;
  }
  const Inputs& inputs() const noexcept { return inputs_; }
  const Inputs& lasting(const Present& present) noexcept {
    static_cast<MotionInputsWithAltitude<Scalar>&>(inputs_) = present;
    std::fill(inputs_.taps.begin(), inputs_.taps.end(), present);
    inputs_.complete = true;
    return inputs_;
  }
  void clear() noexcept {
    past_.clear();
    inputs_.complete = false;
  }

 private:
  using Samples = std::vector<detail::TimedInputs<Present>>;

  detail::PastInputs<Scalar, RunTimeFeatures::Window, Samples> past_;
  Inputs inputs_;
};

}  // namespace pinnquad

namespace programs {

/// Measured beside the motion: the height above the ground, exactly; the columns as they stand where they were given.
template <class Scalar>
struct MeasuredColumns {
  double ground_z_m = 0;  ///< NED
  const std::vector<double>* columns = nullptr;

  void operator()(const pinnquad::State<double>& state, std::uint64_t /*time_us*/,
                  pinnquad::RunTimeFeatures::Inputs<Scalar>& present) const noexcept {
    present.altitude_m = static_cast<Scalar>(ground_z_m - state.position_m[2]);
    for (std::size_t i = 0; i < columns->size(); ++i) present.columns[i] = static_cast<Scalar>((*columns)[i]);
  }
};

/// Any feed-forward that learns nothing behind one type, so that a loop is compiled once. Copies share what was asked.
class AnyFeedForward {
  using State = pinnquad::State<double>;
  using Motion = pinnquad::Accelerations<double>;
  using Commands = pinnquad::Commands<double>;

 public:
  template <class Policy>
  explicit AnyFeedForward(const Policy& policy) {
    const auto held = std::make_shared<Policy>(policy);
    answer_ = [held](auto&&... asked) { return (*held)(asked...); };
    observed_ = [held](auto&&... asked) { return pinnquad::observed_by(*held, asked...); };
    count_ = [held] { return pinnquad::fallback_count(*held); };
  }

  pinnquad::Status operator()(const State& state, const Motion& wanted, std::uint64_t time_us,
                              Commands& commands) noexcept {
    return answer_(state, wanted, time_us, commands);
  }
  pinnquad::Status observed(const State& state, const Motion& flown, std::uint64_t time_us,
                            Commands& commands) noexcept {
    return observed_(state, flown, time_us, commands);
  }
  pinnquad::FallbackCount count() const noexcept { return count_(); }

 private:
  std::function<pinnquad::Status(const State&, const Motion&, std::uint64_t, Commands&)> answer_, observed_;
  std::function<pinnquad::FallbackCount()> count_;
};

/// The feed-forward of a model, which must stay where it is. `columns`: the value of each that it asks for, in their
/// order; read at each tick, where they stand. A window that looks ahead is never complete.
template <class Guard>
AnyFeedForward model_inverse(const pinnquad::BlockModel& model, const Guard& guard, double ground_z_m,
                             const std::vector<double>& columns) {
  return model.with([&](const auto& own) {
    using Scalar = std::decay_t<decltype(*own.parameters())>;
    const auto with = [&](auto features) {
      using Features = decltype(features);
      using Inverse = pinnquad::InverseDynamics<RunTimeView<Features, Scalar>, Guard>;
      using History = pinnquad::InputHistory<Features, Scalar>;
      return AnyFeedForward(pinnquad::NetworkInverse<Inverse, MeasuredColumns<Scalar>>(
          Inverse(RunTimeView<Features, Scalar>(own), guard), {ground_z_m, &columns}, History(own.features())));
    };
    constexpr int few = 24;  // each tick takes the time of all that there is room for
    return own.features().size() <= few ? with(FlightFeatures<few>{}) : with(FlightFeatures<>{});
  });
}

}  // namespace programs
