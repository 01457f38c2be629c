// SPDX-License-Identifier: MIT
// The prediction that a control loop calls: check -> features -> envelope -> scale -> forward -> check, as its Guard
// says. No heap, bounded time; weights stay where the exported header put them, and the object is empty then.
#pragma once

#include <array>

#include "pinnquad/exported/model.hpp"
#include "pinnquad/inference/fallback.hpp"
#include "pinnquad/inference/guard.hpp"
#include "pinnquad/inference/pipeline.hpp"
#include "pinnquad/nn/packed_network.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The model's weights as the vector unit wants them, packed by the compiler.
template <class Model>
inline constexpr PackedPredictor<typename Model::Network> packed_model = [] {
  PackedPredictor<typename Model::Network> packed;
  packed.assign(Model::parameters.data());
  return packed;
}();

/// True for a model whose packed_weights() may be those of the vector unit's kernel: a header's always are, a view's if
/// it was opened so; else they are null.
template <class Model>
inline constexpr bool may_be_packed = has_vector_unit<typename Model::Scalar>&& is_packable<typename Model::Network> &&
                                      (model_kind<Model> == ModelKind::header || model_kind<Model> == ModelKind::view);
template <class Model>
PINNQUAD_ALWAYS_INLINE const PackedPredictor<typename Model::Network>* packed_weights(const Model& model) noexcept {
  if constexpr (model_kind<Model> == ModelKind::view) {
    return model.packed();
  } else {
    return &packed_model<Model>;
  }
}

/// InverseDynamics::Report: why a prediction came out as it did. One type for all guards of a model.
template <class Scalar, int Size>
struct GuardReport {
  Status cause{Status::ok};     ///< the network's own: `ok`, `limited`, or why it declined
  Status fallback{Status::ok};  ///< the fallback's, if it was asked
  bool fallback_asked{false};
  bool commands_clipped{false};  ///< the network's or the fallback's
  Scalar squared_distance{0};    ///< that JointDistance measured; 0 if none was
  /// How far each feature lies outside the envelope, in half-widths of it; 0 inside, not finite for a feature that
  /// isn't. All zero if the inputs were refused before there were features.
  std::array<Scalar, static_cast<std::size_t>(Size)> excess{};
  int worst_feature{-1};  ///< the one furthest outside, -1 if none is
};

/// Stands for a Report where nobody asked why.
struct NoReport {};

/// The distribution of a guard's JointDistance is that of the model.
template <class Model, class Guard>
constexpr bool require_distribution_of_model() noexcept {
  if constexpr (is_guard<Guard>) {
    if constexpr (Guard::measures_distance) return require_distribution<typename Guard::Distribution, Model>();
  }
  return true;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// An exported network as an inverse-dynamics model: motion wanted -> commands.
/// Every function leaves the commands untouched unless has_output(status).
template <class ModelType, class GuardType = TrainingGuard>
class InverseDynamics : private detail::Held<ModelType>, private detail::Held<GuardType> {
  static_assert(require_model<ModelType>());
  static_assert(is_guard<GuardType>,
                "pinnquad: the second argument of InverseDynamics is a Guard (inference/guard.hpp)");
  static_assert(detail::require_distribution_of_model<ModelType, GuardType>());

 public:
  using Model = ModelType;
  using Guard = GuardType;
  using Scalar = typename Model::Scalar;
  using Features = typename Model::Features;
  using Inputs = typename Features::template Inputs<Scalar>;
  using Network = typename Model::Network;
  using Report = detail::GuardReport<Scalar, Features::size>;

  /// For an exported model: it and the guard are types alone. A model or fallback with values of its own must be given.
  InverseDynamics() = default;
  explicit InverseDynamics(const Model& model) noexcept : detail::Held<Model>(model) {}
  explicit InverseDynamics(const Guard& guard) noexcept : detail::Held<Guard>(guard) {}
  InverseDynamics(const Model& model, const Guard& guard) noexcept
      : detail::Held<Model>(model), detail::Held<Guard>(guard) {}

  const Model& model() const noexcept { return detail::Held<Model>::held(); }
  const Guard& guard() const noexcept { return detail::Held<Guard>::held(); }
  /// Sets a model that is opened at run time, in place: a new InverseDynamics would be on the stack beside the old.
  void set_model(const Model& model) noexcept { detail::Held<Model>::hold(model); }

  /// Commands that make the motion asked for; not clipped to 0..1 unless the guard does (the rotor clips).
  /// `ok`, `limited`: the network's. `fell_back`: the fallback's. `not_finite`, `not_unit_quaternion`: a bad input.
  /// `outside_envelope`: a feature beyond the training data. `outside_distribution`: all together too far from it
  /// (JointDistance). `outside_limits`: the guard refuses the commands. `output_not_finite`: the network's weights are
  /// broken.
  Status predict(const Inputs& inputs, Commands<Scalar>& commands) const noexcept {
    detail::NoReport none;
    return guarded(inputs, commands, none);
  }
  /// The commands are Commands<Scalar>: four of the model's own scalar.
  template <class Other>
  Status predict(const Inputs& inputs, Other& not_commands_of_this_scalar) const = delete;
  /// The same, and why.
  Status predict(const Inputs& inputs, Commands<Scalar>& commands, Report& report) const noexcept {
    report = {};
    return guarded(inputs, commands, report);
  }
  /// The same for a fallback that needs to know where and when.
  template <class Real>
  Status predict(const Inputs& inputs, const PlaceAndTime<Real>& place, Commands<Scalar>& commands) const noexcept {
    detail::NoReport none;
    return guarded(inputs, commands, none, place);
  }
  template <class Real>
  Status predict(const Inputs& inputs, const PlaceAndTime<Real>& place, Commands<Scalar>& commands,
                 Report& report) const noexcept {
    report = {};
    return guarded(inputs, commands, report, place);
  }

  /// predict() where the network must not be asked, for a reason that the caller knows: the fallback's commands
  /// (`fell_back`), or `cause`, a Status without output. `place`: nothing, or a PlaceAndTime.
  template <class... Place>
  Status without_network(Status cause, const Inputs& inputs, Commands<Scalar>& commands, Report& report,
                         const Place&... place) const noexcept {
    report = {};
    report.cause = cause;
    return declined(cause, inputs, commands, report, place...);
  }

  /// The network's answer to a feature vector X, physical units, under all of the guard but its fallback, which needs
  /// the inputs. `not_finite` for NaN or infinity that no envelope refuses.
  Status predict_features(const Scalar* x, Commands<Scalar>& commands) const noexcept {
    return predict_features(x, commands.data());
  }
  /// The same into four numbers.
  Status predict_features(const Scalar* x, Scalar* commands) const noexcept {
    detail::NoReport none;
    Scalar asked[rotor_count] = {};
    const Status status = ask_network(x, asked, none);
    if (has_output(status)) {
      for (int i = 0; i < rotor_count; ++i) commands[i] = asked[i];
    }
    return status;
  }

  /// The network alone, without any check: features X -> commands. For self_test(), not for motors.
  PINNQUAD_ALWAYS_INLINE void evaluate(const Scalar* x, Scalar* commands) const noexcept {
    Scalar outputs[Network::outputs] = {};
    Pipeline::run(detail::scales_of(model()), x, outputs, commands,
                  [this](const Scalar* standardised, Scalar* made)
                      PINNQUAD_INLINE_LAMBDA { forward(standardised, made); });
  }
  /// The same, and x is overwritten: less of the stack.
  PINNQUAD_ALWAYS_INLINE void evaluate_over(Scalar* x, Scalar* commands) const noexcept {
    Pipeline::run_over(detail::scales_of(model()), x, commands,
                       [this](const Scalar* standardised, Scalar* made)
                           PINNQUAD_INLINE_LAMBDA { forward(standardised, made); });
  }

  /// The network's answer to a motion that was measured, without guard: `ok`, or `limited` outside the envelope. A
  /// Status of the features' check, `not_finite` and `output_not_finite` leave the commands untouched.
  PINNQUAD_NOINLINE Status observed(const Inputs& measured, Commands<Scalar>& commands) const noexcept {
    const Status checked = Features::check(measured);
    if (checked != Status::ok) return checked;
    Scalar x[Features::size];
    Features::extract(measured, x);
    if (!all_finite(x, Features::size)) return Status::not_finite;
    const bool inside = inside_envelope(x);
    Commands<Scalar> said{};
    evaluate_over(x, said.data());
    if (!all_finite(said)) return Status::output_not_finite;
    commands = said;
    return inside ? Status::ok : Status::limited;
  }

  /// True if every feature but the columns lies in the training rows' range, margin included; false for NaN, under
  /// -ffast-math too.
  PINNQUAD_ALWAYS_INLINE bool inside_envelope(const Scalar* x) const noexcept {
    const detail::Scales<Scalar> scales = detail::scales_of(model());
    bool inside = all_finite(x, Features::size);
    for (int i = 0; i < Features::size; ++i) inside &= within(scales, x, i);
    return inside;
  }

  /// True if the features together lie as near to the training rows as the guard asks; leaves the squared distance.
  /// Always true of a guard without JointDistance.
  PINNQUAD_ALWAYS_INLINE bool inside_distribution(const Scalar* x, Scalar& squared) const noexcept {
    if constexpr (Guard::measures_distance) {
      squared = squared_joint_distance<typename Guard::Distribution>(x);
      return is_finite(squared) && squared <= Scalar(Guard::Distribution::squared_distance_limit);
    } else {
      return true;
    }
  }

  /// The bare network, standardised in and out: the model's own forward() if it has one; else the vector unit's kernel
  /// where there is one, else the portable one. Out of line: all ways to the network share its code.
  PINNQUAD_NOINLINE void forward(const Scalar* standardised, Scalar* outputs) const noexcept {
    if constexpr (model_kind<Model> != ModelKind::header) {
      model().forward(standardised, outputs);
    } else if constexpr (detail::may_be_packed<Model>) {
      detail::packed_model<Model>.forward(standardised, outputs);
    } else {
      constexpr const Scalar* weights = Model::parameters.data();
      Network::forward(weights, standardised, outputs);
    }
  }

 private:
  static PINNQUAD_ALWAYS_INLINE bool within(const detail::Scales<Scalar>& scales, const Scalar* x, int i) noexcept {
    return detail::is_column<Features>(i) || (x[i] >= scales.lower[i] && x[i] <= scales.upper[i]);
  }

  using Pipeline = detail::Pipeline<Features, typename Model::Outputs, typename Model::Vehicle>;
  template <class ReportType>
  static constexpr bool reports = !std::is_same_v<ReportType, detail::NoReport>;

  template <class ReportType, class... Place>
  PINNQUAD_ALWAYS_INLINE Status guarded(const Inputs& inputs, Commands<Scalar>& commands, ReportType& report,
                                        const Place&... place) const noexcept {
    Scalar asked[rotor_count] = {};
    const Status status = ask_network(inputs, asked, report);
    if constexpr (reports<ReportType>) report.cause = status;
    if (has_output(status)) {
      for (std::size_t i = 0; i < rotor_count; ++i) commands[i] = asked[i];
      return status;
    }
    if constexpr (detail::answers_beyond_envelope<InverseDynamics>) {
      if (status == Status::outside_envelope &&
          detail::answer_beyond_envelope(*this, inputs, commands, report, place...)) {
        return Status::fell_back;
      }
    }
    return declined(status, inputs, commands, report, place...);
  }

  template <class ReportType>
  PINNQUAD_ALWAYS_INLINE Status ask_network(const Inputs& inputs, Scalar* commands, ReportType& report) const noexcept {
    if constexpr (Guard::checks_inputs) {
      const Status checked = Features::check(inputs);
      if (checked != Status::ok) return checked;
    }
    Scalar x[Features::size];
    Features::extract(inputs, x);
    return ask_network(static_cast<Scalar*>(x), commands, report);
  }

  /// `Value`: Scalar, or const Scalar of features that must stay.
  template <class Value, class ReportType>
  PINNQUAD_ALWAYS_INLINE Status ask_network(Value* x, Scalar* commands, ReportType& report) const noexcept {
    if constexpr (Guard::refuses_outside_envelope) {
      if (!inside_envelope(x)) {
        if constexpr (reports<ReportType>) measure(x, report);
        return Status::outside_envelope;
      }
    } else {
      if constexpr (reports<ReportType>) {
        if (!inside_envelope(x)) measure(x, report);
      }
      if (!all_finite(x, Features::size)) return Status::not_finite;
    }
    if (!near_enough(x, report)) return Status::outside_distribution;
    if constexpr (std::is_const_v<Value>) {
      evaluate(x, commands);
    } else {
      evaluate_over(x, commands);
    }
    const Status checked = Guard::check_commands(commands);
    if constexpr (reports<ReportType>) report.commands_clipped = checked == Status::limited;
    return checked;
  }

  template <class ReportType>
  PINNQUAD_ALWAYS_INLINE bool near_enough(const Scalar* x, ReportType& report) const noexcept {
    Scalar squared(0);
    const bool inside = inside_distribution(x, squared);
    if constexpr (reports<ReportType>) report.squared_distance = squared;
    return inside;
  }

  /// The fallback's commands, or `cause`.
  template <class ReportType, class... Place>
  Status declined(Status cause, const Inputs& inputs, Commands<Scalar>& commands, ReportType& report,
                  const Place&... place) const noexcept {
    if constexpr (Guard::falls_back) {
      return fall_back(inputs, commands, report, place...) ? Status::fell_back : cause;
    } else {
      return cause;
    }
  }

  /// Asks the fallback; true if its commands were written. Out of line: the network's way is the hot one.
  template <class ReportType, class... Place>
  PINNQUAD_NOINLINE bool fall_back(const Inputs& inputs, Commands<Scalar>& commands, ReportType& report,
                                   const Place&... place) const noexcept {
    Commands<Scalar> replaced{};
    Status status = detail::ask_fallback(guard().fallback(), inputs, replaced, place...);
    if (has_output(status)) status = Guard::check_commands(replaced.data());
    if constexpr (reports<ReportType>) {
      report.fallback_asked = true;
      report.fallback = status;
      report.commands_clipped = status == Status::limited;
    }
    if (!has_output(status)) return false;
    commands = replaced;
    return true;
  }

  /// Fills in how far features lie outside, of a report that is as made.
  PINNQUAD_NOINLINE void measure(const Scalar* x, Report& report) const noexcept {
    const detail::Scales<Scalar> scales = detail::scales_of(model());
    Scalar worst(0);
    for (int i = 0; i < Features::size; ++i) {
      if (is_finite(x[i]) && within(scales, x, i)) continue;
      const Scalar beyond = x[i] < scales.lower[i] ? scales.lower[i] - x[i] : x[i] - scales.upper[i];  // NaN stays NaN
      const Scalar excess = beyond / ((scales.upper[i] - scales.lower[i]) / Scalar(2));
      report.excess[static_cast<std::size_t>(i)] = excess;
      // what is not finite outdoes every number, the first of them all
      if (is_finite(worst) && (!is_finite(excess) || excess > worst)) {
        worst = excess;
        report.worst_feature = i;
      }
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
