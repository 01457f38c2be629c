// SPDX-License-Identifier: MIT
// Of a model all that `certify` finds: what is proven of the signs of its slopes, or the search for two motions that
// refute it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "model/counterexample.hpp"
#include "model/response.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// All that is known of a model in the end.
struct Findings {
  std::optional<pinnquad::BlockModel::ProvenSigns> proof;
  std::optional<Response> thrust;  ///< of the structure, to more thrust at all instants
  /// Of a window, to an acceleration that is held with the body rates that it makes; where it can be worked out.
  std::array<std::optional<Response>, 3> with_rates;
  Search search;                   ///< where nothing is proven
  std::vector<AskedMore> ways;     ///< of the search
  std::vector<std::string> names;  ///< of the features
  bool past_or_future = false;     ///< other taps of a window show an angular acceleration too
  /// Features of an affine base, and of its residual, that show an angular acceleration beside the threes that it
  /// counts, and features of which nobody knows. With one nothing is proven of the structure.
  std::vector<std::string> uncounted;

  bool proven() const { return proof.has_value(); }
  /// Not null for a proof by structure.
  const pinnquad::Certificate* certificate() const { return proof && proof->structure ? &*proof->structure : nullptr; }
};

/// Searches for `seconds` of the processor where nothing is proven. Throws InputError for a model that is asked no
/// angular acceleration of the present.
Findings findings_of(const pinnquad::BlockModel& model, double seconds, std::uint64_t seed);

/// The proof's argument.
const char* in_words(const pinnquad::BlockModel::ProvenSigns& proof);

/// True for a model with the base of a residual.
bool has_base(const pinnquad::BlockModel& model);

/// The thrust slope at every input: the base's with what the residual's paths may take off; -infinity where nobody can
/// bound them.
double least_thrust_slope(const Findings& findings);

/// Time constants of the bias that is learnt in flight; none where the model says none.
std::optional<std::array<double, 4>> bias_time_constants_s(const pinnquad::BlockModel& model);

/// The answer of `certify --json`.
nlohmann::json findings_json(const pinnquad::BlockModel& model, const Findings& findings);

}  // namespace programs
