// SPDX-License-Identifier: MIT
// An InverseDynamics behind a CommandResidualMonitor: observe() what was flown, predict() what to fly. While the
// command residual is above its limit the model is not asked: the guard's fallback flies, or nobody (`distrusted`).
#pragma once

#include "pinnquad/inference/command_residual.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// `Inverse`: an InverseDynamics. `Trust`: CommandResidualMonitor's. The monitor goes on while the fallback flies: a
/// model that is right again flies again.
/// Threads: the const calls may run at once, if the fallback's may. observe() and reset() write the monitor: while one
/// of them runs, no other call on the same object may.
template <class Inverse, class Trust>
class MonitoredInverse : private detail::Held<Inverse> {
 public:
  using Scalar = typename Inverse::Scalar;
  using Inputs = typename Inverse::Inputs;
  using Report = typename Inverse::Report;
  using Monitor = CommandResidualMonitor<Trust, Scalar>;

  MonitoredInverse() = default;
  explicit MonitoredInverse(const Inverse& inverse) noexcept : detail::Held<Inverse>(inverse) {}

  const Inverse& inverse() const noexcept { return detail::Held<Inverse>::held(); }
  const Monitor& monitor() const noexcept { return monitor_; }
  bool trusted() const noexcept { return monitor_.trusted(); }
  void reset() noexcept { monitor_.reset(); }

  /// A measured motion, and the commands that were flown in it. The bare network is asked, inside the envelope or not.
  /// Unless `ok` nothing changes: a Status of the features' check, `output_not_finite`, `not_finite`.
  Status observe(const Inputs& measured, const Commands<Scalar>& flown) noexcept {
    Commands<Scalar> predicted{};
    const Status status = inverse().observed(measured, predicted);
    if (!has_output(status)) return status;
    return monitor_.update(predicted, flown);
  }

  /// As Inverse::predict(); while the model is distrusted `fell_back` or `distrusted`.
  Status predict(const Inputs& inputs, Commands<Scalar>& commands, Report& report) const noexcept {
    return trusted() ? inverse().predict(inputs, commands, report)
                     : inverse().without_network(Status::distrusted, inputs, commands, report);
  }
  Status predict(const Inputs& inputs, Commands<Scalar>& commands) const noexcept {
    if (trusted()) return inverse().predict(inputs, commands);
    Report unread;
    return inverse().without_network(Status::distrusted, inputs, commands, unread);
  }
  /// The same for a fallback that depends on place and time.
  template <class Real>
  Status predict(const Inputs& inputs, const PlaceAndTime<Real>& place, Commands<Scalar>& commands,
                 Report& report) const noexcept {
    return trusted() ? inverse().predict(inputs, place, commands, report)
                     : inverse().without_network(Status::distrusted, inputs, commands, report, place);
  }
  template <class Real>
  Status predict(const Inputs& inputs, const PlaceAndTime<Real>& place, Commands<Scalar>& commands) const noexcept {
    if (trusted()) return inverse().predict(inputs, place, commands);
    Report unread;
    return inverse().without_network(Status::distrusted, inputs, commands, unread, place);
  }

 private:
  Monitor monitor_{};
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
