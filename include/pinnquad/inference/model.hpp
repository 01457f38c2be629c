// SPDX-License-Identifier: MIT
// The contract of an exported model, a struct with static constexpr members that deploy/header_writer.hpp writes: types Scalar,
// Network, Features, Outputs, Vehicle; arrays parameters, envelope_lower, envelope_upper, golden_features, golden_commands;
// scalers input and output; format_version, name and provenance strings.
#pragma once

#include "pinnquad/inference/features.hpp"
#include "pinnquad/inference/output_schema.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/scaler.hpp"

namespace pinnquad {

/// Format that this library writes and reads. A header of another format does not compile.
inline constexpr int model_format_version = 1;

/// Largest difference between a golden command and its replay: float rounding over the network's sums, with a factor of about
/// ten to spare.
inline constexpr double golden_tolerance = 1e-5;

namespace detail {
template <class M, class = void>
struct IsModel : std::false_type {};
template <class M>
struct IsModel<M, std::void_t<typename M::Scalar, typename M::Network, typename M::Features, typename M::Outputs,
                              typename M::Vehicle, decltype(M::format_version), decltype(M::parameters),
                              decltype(M::input), decltype(M::output), decltype(M::envelope_lower),
                              decltype(M::envelope_upper), decltype(M::golden_features), decltype(M::golden_commands)>>
    : std::true_type {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class M>
inline constexpr bool is_model = detail::IsModel<M>::value;

/// Checks, at compile time and by rule, that the parts of a model fit together.
template <class M>
constexpr bool require_model() noexcept {
  static_assert(is_model<M>, "pinnquad: this type is not an exported model (inference/model.hpp)");
  if constexpr (is_model<M>) {
    static_assert(M::format_version == model_format_version,
                  "pinnquad: the model was exported in another format; export it again with this version");
    static_assert(is_network<typename M::Network>, "pinnquad: the model's Network is not a pinnquad::Network");
    static_assert(is_feature_set<typename M::Features>, "pinnquad: the model's Features are not a feature set");
    static_assert(is_output_schema<typename M::Outputs>, "pinnquad: the model's Outputs are not an output schema");
    static_assert(is_airframe<typename M::Vehicle>, "pinnquad: the model's Vehicle is not an airframe");
    static_assert(M::Network::inputs == M::Features::size,
                  "pinnquad: the network's input count differs from the feature set's size");
    static_assert(M::Network::outputs == rotor_count,
                  "pinnquad: the network's output count differs from the rotor count");
    static_assert(M::parameters.size() == static_cast<std::size_t>(M::Network::parameter_count),
                  "pinnquad: the exported parameters do not have the network's length");
    static_assert(M::input.size == M::Features::size && M::output.size == rotor_count,
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
  }
  return is_model<M>;
}

}  // namespace pinnquad
