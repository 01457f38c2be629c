// SPDX-License-Identifier: MIT
// The contract of an exported model, a struct with static constexpr members that deploy/header_writer.hpp writes. The
// format is described here once; what a header says of itself is checked against what the including code's types say.
#pragma once

#include <cstdint>
#include <string_view>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/exported/model_facts.hpp"
#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"

namespace pinnquad {

/// The format of headers: this library writes it and reads no other one. A header has the types Scalar, Network,
/// Features, Outputs, Vehicle; the arrays parameters, envelope_lower, envelope_upper, golden_features, golden_commands,
/// allocation (Eq. (2) at the rated density); the scalers input, output; format_version, training_data_hash,
/// training_rows; its facts (exported/model_facts.hpp): command_meaning, command_lower, command_upper, sample_period_s,
/// lag_removed_s; shape_hash and contents_hash (exported/contents_hash.hpp). Optional facts: worse_than_mean,
/// beats_linear_regression, test_r_squared, linear_regression_r_squared (finite) of a model that was judged
/// (evaluation/errors.hpp); bias_time_constants_s, of which no hash is. A Vehicle that is none of the library's stands
/// before the model, in the same header. The block beside the header says the same hashes (exported/model_block.hpp).
inline constexpr int header_format_version = 5;

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
    std::void_t<FormatOf<M>, decltype(std::uint64_t{M::training_data_hash}), decltype(int{M::training_rows}),
                decltype(CommandMeaning{M::command_meaning}), decltype(M::command_lower), decltype(M::command_upper),
                decltype(M::sample_period_s), decltype(M::lag_removed_s), decltype(M::allocation),
                decltype(std::uint64_t{M::shape_hash}), decltype(std::uint64_t{M::contents_hash})>;

template <class M>
constexpr void require_facts() noexcept {
  constexpr bool four = [] {
    if constexpr (is_detected<BiasTimeConstantsOf, M>) return M::bias_time_constants_s.size() == 4;
    return true;
  }();
  static_assert(four, "pinnquad: the model's time constants of a bias are not four (bias_time_constants_s)");
  if constexpr (four) {
    constexpr StatedNumber fault = fault_of(facts_of_header<M>(), FiniteConstant{}).number;
    static_assert(fault != StatedNumber::command_range,
                  "pinnquad: the range of the model's commands is none, or beyond -1 to 1: a command is a share of the "
                  "full one (command_lower, command_upper)");
    static_assert(fault != StatedNumber::sample_period_s && fault != StatedNumber::lag_removed_s,
                  "pinnquad: the model's sample period or removed lag is no time of 0 to 4 s that it can be: a period "
                  "is 0 (not said) or 0.00001 s and more, a lag 1 s at most (sample_period_s, lag_removed_s)");
    static_assert(fault != StatedNumber::r_squared,
                  "pinnquad: an R^2 of the model is above 1 or no number (test_r_squared, "
                  "linear_regression_r_squared)");
    static_assert(fault != StatedNumber::judged_figures,
                  "pinnquad: the model's verdict is not that of its R^2 (test_r_squared, linear_regression_r_squared, "
                  "worse_than_mean, beats_linear_regression)");
    static_assert(fault != StatedNumber::bias_time_constant_s,
                  "pinnquad: a time constant of the model's bias is no time of 0 to 60 s that a bias can have: 0 "
                  "(none of this sum), or 0.02 s and more (bias_time_constants_s)");
  }
}

/// The first fault of an exported header's numbers.
template <class M>
constexpr StatedNumber fault_of_header() noexcept {
  return fault_of_numbers(
      FiniteConstant{}, scales_in_header<M>(), M::envelope_lower.size(), M::output.mean.size(), M::parameters.data(),
      M::parameters.size(), [](std::size_t i) { return M::golden_features[i].data(); },
      [](std::size_t i) { return M::golden_commands[i].data(); }, M::golden_features.size());
}

template <class M>
constexpr void require_numbers() noexcept {
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
}

/// Compares what a header says with its types and with what a model can say.
template <class M>
constexpr void require_description() noexcept {
  static_assert(is_detected<DescriptionOf, M>,
                "pinnquad: the model lacks what its format demands: meaning and range of the commands, clock, "
                "allocation, hash of the training data, shape_hash, contents_hash (exported/model.hpp)");
  if constexpr (is_detected<DescriptionOf, M>) {
    static_assert(
        M::shape_hash == pinnquad::shape_hash<M>,
        "pinnquad: the model was trained for another shape than its types now have: a layer, a name or unit of a "
        "feature or an output, the airframe's name or the motor order (a rotor sits or turns elsewhere) is another "
        "(shape_hash)");
    using Window = WindowOf<typename M::Features>;
    static_assert(Window::period_s <= 0.0 || same_period(M::sample_period_s, Window::period_s),
                  "pinnquad: the model's sample period is another than its window's (sample_period_s)");
    static_assert(same_header_allocation<M>(),
                  "pinnquad: the model was trained for another allocation than its Vehicle now has (allocation)");
    require_facts<M>();
    require_numbers<M>();
    static_assert(same_contents<M>(),
                  "pinnquad: the header, or the airframe that it was trained for, was edited since it was exported: "
                  "a number is another, or window, columns or base of its types are (contents_hash); export it again");
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
    return M::format_version == header_format_version;
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
    return detail::require_format<M::format_version, header_format_version>();
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
