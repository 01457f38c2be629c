// SPDX-License-Identifier: MIT
// The contract of an exported model, a struct with static constexpr members that deploy/header_writer.hpp writes. The
// format is described here once; what a header says of itself is checked against what the including code's types say.
#pragma once

#include <cstdint>
#include <string_view>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/exported/model_agreement.hpp"
#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"

namespace pinnquad {

/// The format of headers and blocks, one number for both: this library writes it and reads no other one.
/// A header has the types Scalar, Network, Features, Outputs, Vehicle; the arrays parameters, envelope_lower,
/// envelope_upper, golden_features, golden_commands; the scalers input, output; format_version, frame, feature_names,
/// feature_units, output_names, output_units, vehicle_name, motor_torque_signs, training_data_hash, training_rows;
/// records, and what they name (exported/model_records.hpp); contents_hash, over all of it
/// (exported/contents_hash.hpp). Optional, of a model that was judged: test_r_squared, linear_regression_r_squared
/// (finite), worse_than_mean, beats_linear_regression (evaluation/errors.hpp). A Vehicle that is none of the library's
/// stands before the model, in the same header. The block beside the header says the same hash
/// (exported/model_block.hpp).
inline constexpr int model_format_version = 4;

/// The frames of every feature set, as a header states them.
inline constexpr const char* model_frame = "body FRD, world NED";

/// Largest difference between a golden command and its replay: float rounding over the network's sums, with a factor of
/// about ten to spare.
inline constexpr double golden_tolerance = 1e-5;

/// Where a model in memory keeps its numbers. A type says its own as `static constexpr ModelKind kind`; an exported
/// header says none.
enum class ModelKind {
  header,    ///< constants of the compiler: an exported header
  instance,  ///< members of the instance, `parameters` among them, and a forward() of its own
  function,  ///< a forward() of its own, for a Shape; no weights to show
  view,      ///< for a Shape; weights in a block, behind parameters(), and packed() if asked for: ModelView
};

namespace detail {
template <class S>
using ShapeTypes = std::void_t<typename S::Scalar, typename S::Network, typename S::Features, typename S::Outputs,
                               typename S::Vehicle>;
template <class S>
inline constexpr bool has_shape = is_detected<ShapeTypes, S>;

template <class M>
using ModelMembers = std::void_t<ShapeTypes<M>, decltype(M::parameters), decltype(M::input), decltype(M::output),
                                 decltype(M::envelope_lower), decltype(M::envelope_upper), decltype(M::golden_features),
                                 decltype(M::golden_commands)>;
template <class M>
using FormatOf = decltype(int{M::format_version});
template <class M>
using DescriptionOf =
    std::void_t<FormatOf<M>, decltype(M::frame), decltype(M::feature_names), decltype(M::feature_units),
                decltype(M::output_names), decltype(M::output_units), decltype(M::vehicle_name),
                decltype(M::motor_torque_signs), decltype(std::uint64_t{M::training_data_hash}),
                decltype(int{M::training_rows}), RecordsOf<M>, decltype(std::uint64_t{M::contents_hash})>;

/// All texts are one.
template <class Texts>
constexpr bool one_unit(const Texts& texts) noexcept {
  for (const auto& text : texts) {
    if (!same_values(text, texts[0])) return false;
  }
  return true;
}

/// The first fault of the numbers that every model has.
template <class M>
constexpr StatedNumber fault_of_header() noexcept {
  return fault_of_numbers(
      FiniteConstant{}, scales_in_header<M>(), M::envelope_lower.size(), M::output.mean.size(), M::parameters.data(),
      M::parameters.size(), [](std::size_t i) { return M::golden_features[i].data(); },
      [](std::size_t i) { return M::golden_commands[i].data(); }, M::golden_features.size());
}

template <class M>
using TestFigureOf = decltype(double{M::test_r_squared});
template <class M>
using LinearFigureOf = decltype(double{M::linear_regression_r_squared});

template <class M>
constexpr bool are_header_figures() noexcept {
  bool sound = true;
  if constexpr (is_detected<TestFigureOf, M>) sound = sound && in_range<StatedNumber::r_squared>(M::test_r_squared);
  if constexpr (is_detected<LinearFigureOf, M>) {
    sound = sound && in_range<StatedNumber::r_squared>(M::linear_regression_r_squared);
  }
  return sound;
}

/// A linear regression whose R^2 was no number is not stated; the model beats it.
template <class M>
constexpr bool header_verdict_is_borne_out() noexcept {
  if constexpr (is_detected<StatedVerdictOf, M> && is_detected<TestFigureOf, M>) {
    double linear = -no_bound;
    if constexpr (is_detected<LinearFigureOf, M>) linear = M::linear_regression_r_squared;
    return bears_out(M::worse_than_mean, M::beats_linear_regression, M::test_r_squared, linear);
  }
  return true;
}

/// Compares the words of a header with its types.
template <class M>
constexpr void require_description() noexcept {
  static_assert(is_detected<DescriptionOf, M>,
                "pinnquad: the model lacks what its format demands: frame, names, units, vehicle, motor order, hash of "
                "the training data, records, contents_hash (exported/model.hpp)");
  if constexpr (is_detected<DescriptionOf, M>) {
    using Features = typename M::Features;
    using Outputs = typename M::Outputs;
    static_assert(same_values(M::frame, model_frame), "pinnquad: the model was trained in other frames (frame)");
    static_assert(same_values(M::feature_names, Features::names),
                  "pinnquad: the model was trained on other features than its feature set now has (feature_names)");
    static_assert(same_values(M::feature_units, Features::units),
                  "pinnquad: the model was trained in other units than its feature set now has (feature_units)");
    static_assert(same_values(M::output_names, OutputMap<Outputs>::names),
                  "pinnquad: the model has other outputs than its output schema now has (output_names)");
    static_assert(same_values(M::output_units, OutputMap<Outputs>::units),
                  "pinnquad: the model's outputs have another unit than its output schema (output_units)");
    static_assert(same_values(M::vehicle_name, M::Vehicle::name),
                  "pinnquad: the model was trained for another airframe than its Vehicle (vehicle_name)");
    static_assert(
        same_values(M::motor_torque_signs, motor_torque_signs<typename M::Vehicle>()),
        "pinnquad: the model was trained with another motor order than its Vehicle now has: a rotor sits or turns "
        "elsewhere (motor_torque_signs)");
    constexpr StatedNumber fault = fault_of_header<M>();
    static_assert(fault != StatedNumber::weight, "pinnquad: a weight of the model is NaN or infinite");
    static_assert(fault != StatedNumber::scaler, "pinnquad: a scaler's number is NaN or infinite");
    static_assert(fault != StatedNumber::border, "pinnquad: a border of the model's envelope is NaN or infinite");
    static_assert(fault != StatedNumber::deviation, "pinnquad: a scaler's standard deviation is not positive");
    static_assert(fault != StatedNumber::envelope,
                  "pinnquad: the model's envelope is upside down, or ends where no training on features of its mean "
                  "and standard deviation can have been (envelope_lower, envelope_upper, input)");
    static_assert(fault != StatedNumber::golden_command, "pinnquad: a golden command is NaN or infinite");
    static_assert(fault != StatedNumber::golden_vector, "pinnquad: a golden vector lies outside the model's envelope");
    static_assert(are_header_figures<M>(),
                  "pinnquad: an R^2 of the model is above 1 or no number (test_r_squared, "
                  "linear_regression_r_squared)");
    static_assert(header_verdict_is_borne_out<M>(),
                  "pinnquad: the model's verdict is not that of its R^2 (test_r_squared, linear_regression_r_squared, "
                  "worse_than_mean, beats_linear_regression)");
    require_records<M>();
    static_assert(same_contents<M>(),
                  "pinnquad: the header, or the airframe that it was trained for, was edited since it was exported: "
                  "a number, a name or a text is another (contents_hash); export it again");
  }
}

/// The compiler names both formats beside the message.
template <int found, int expected>
constexpr bool require_format() noexcept {
  static_assert(found == expected,
                "pinnquad: the model's header has the format `found`, and this library reads the format `expected` "
                "(numbers of require_format, in the lines about this one): train and export again");
  return true;
}
/// True where M says no format: a header must, and is refused for what it lacks.
template <class M>
constexpr bool is_of_this_format() noexcept {
  if constexpr (is_detected<FormatOf, M>) {
    return M::format_version == model_format_version;
  } else {
    return true;
  }
}
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class M>
inline constexpr bool is_model = is_detected<detail::ModelMembers, M>;

/// The kind of a model: stated by the type, `header` where it states none.
template <class M, class = void>
inline constexpr ModelKind model_kind = ModelKind::header;
template <class M>
inline constexpr ModelKind model_kind<M, std::void_t<decltype(M::kind)>> = M::kind;

/// Checks, at compile time and by rule, that the types of a model fit together, wherever its weights are.
template <class S>
constexpr bool require_shape() noexcept {
  static_assert(detail::has_shape<S>,
                "pinnquad: this type names no Scalar, Network, Features, Outputs and Vehicle (exported/model.hpp)");
  if constexpr (detail::has_shape<S>) {
    static_assert(
        is_predictor<typename S::Network>,
        "pinnquad: the model's Network is neither a pinnquad::Network nor another predictor (model/predictor.hpp)");
    static_assert(is_feature_set<typename S::Features>, "pinnquad: the model's Features are not a feature set");
    static_assert(is_output_schema<typename S::Outputs>, "pinnquad: the model's Outputs are not an output schema");
    if constexpr (is_feature_set<typename S::Features>) {
      static_assert(
          detail::is_noexcept_feature_set<typename S::Features>,
          "pinnquad: a feature set's check() and extract() must be noexcept: they fly (features/features.hpp)");
    }
    if constexpr (is_output_schema<typename S::Outputs>) {
      static_assert(detail::is_noexcept_output_schema<typename S::Outputs>,
                    "pinnquad: an output schema's functions must be noexcept: they fly (outputs/output_schema.hpp)");
    }
    static_assert(is_airframe<typename S::Vehicle>, "pinnquad: the model's Vehicle is not an airframe");
    static_assert(std::is_same_v<typename S::Scalar, typename S::Network::Scalar>,
                  "pinnquad: the model's Scalar is not that of its Network");
    static_assert(S::Network::inputs == S::Features::size,
                  "pinnquad: the network's input count differs from the feature set's size");
    if constexpr (is_output_schema<typename S::Outputs>) {
      static_assert(S::Network::outputs == OutputMap<typename S::Outputs>::size,
                    "pinnquad: the network's output count differs from the output schema's size");
      static_assert(base_reads<typename S::Features, typename S::Outputs>(),
                    "pinnquad: the outputs' base reads a feature that the feature set has not, or not there: "
                    "LinearizedBase is of what begins as PaperFeatures, RigidBodyBase as PhysicsFeatures "
                    "(outputs/base.hpp)");
    }
  }
  return detail::has_shape<S>;
}

/// The same for a whole model. Of a header: its types, its arrays, and its description. Of a model made for a shape:
/// the types; its numbers were checked when its block was opened. An instance is checked by the code that made it.
template <class M>
constexpr bool require_model() noexcept {
  constexpr bool made_for_shape = ModelKind::instance < model_kind<M>;
  static_assert(is_model<M> || made_for_shape, "pinnquad: this type is not an exported model (exported/model.hpp)");
  if constexpr (made_for_shape) {
    return require_shape<typename M::Shape>();
  } else if constexpr (!is_model<M> || model_kind<M> != ModelKind::header) {
    return is_model<M>;
  } else if constexpr (!detail::is_of_this_format<M>()) {
    return detail::require_format<M::format_version, model_format_version>();
  } else {
    static_assert(require_shape<M>());
    static_assert(M::parameters.size() == static_cast<std::size_t>(M::Network::parameter_count),
                  "pinnquad: the exported parameters do not have the network's length");
    static_assert(M::input.size == M::Features::size && M::output.size == OutputMap<typename M::Outputs>::size,
                  "pinnquad: a scaler does not have the length of what it scales");
    static_assert(M::envelope_lower.size() == static_cast<std::size_t>(M::Features::size) &&
                      M::envelope_upper.size() == static_cast<std::size_t>(M::Features::size),
                  "pinnquad: the envelope does not have the length of the feature set");
    static_assert(M::golden_features.size() == M::golden_commands.size() && M::golden_features.size() > 0,
                  "pinnquad: the model has no golden vectors");
    static_assert(std::tuple_size<typename std::decay_t<decltype(M::golden_features)>::value_type>::value ==
                          static_cast<std::size_t>(M::Features::size) &&
                      std::tuple_size<typename std::decay_t<decltype(M::golden_commands)>::value_type>::value ==
                          static_cast<std::size_t>(rotor_count),
                  "pinnquad: a golden vector does not have the length of features or commands");
    detail::require_description<M>();
    return true;
  }
}

}  // namespace pinnquad
