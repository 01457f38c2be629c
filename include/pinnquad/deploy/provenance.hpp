// SPDX-License-Identifier: MIT
// The words of an export beside its numbers: where a model comes from, in which terms it was trained, what was found
// out about it. Header (exported/model.hpp) and block (exported/model_block.hpp) write the same records of it.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/exported/model_block.hpp"
#include "pinnquad/exported/model_facts.hpp"
#include "pinnquad/exported/run_time_outputs.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/training/ground_outputs.hpp"
#include "pinnquad/training/structured/measured_slope.hpp"

namespace pinnquad {

/// Where a model comes from; printed into the header as strings.
struct Provenance {
  std::string training_data;             ///< name of the flight, not a path of the machine
  std::uint64_t training_data_hash = 0;  ///< content_hash() of the flight
  std::size_t training_rows = 0;
  std::uint64_t seed = 0;
  int epochs = 0;
  std::string loss;                               ///< in words
  std::optional<Verdict> verdict = std::nullopt;  ///< how the model was judged; none: the header says nothing of it

  /// The meaning of a recorded command; none: the airframe's curves say it (command_meaning_of()).
  std::optional<CommandMeaning> command_meaning = std::nullopt;
  double command_lower = 0;  ///< the range that commands were given in
  double command_upper = 1;
  double sample_period_s = 0;  ///< of the flights; 0: not said, or that of the features' window
  double lag_removed_s = 0;    ///< of the rotors, taken out of the commands before the training

  // of the header's first lines (deploy/opening_comment.hpp)
  bool signs_unproven = false;
  /// Proven: least slopes of the signed sums, s^2/rad. A model with a certificate has its own.
  std::optional<AxisSlopes> proven_slopes = std::nullopt;
  SlopesOfSums slopes{};       ///< as the training rows know them
  std::string fitness{};       ///< may it fly, and what to do next, without a full stop; empty: nothing is said
  std::string beside{};        ///< its error beside those of others, as fitness
  bool airframe_known = true;  ///< false: slopes are not told over those of the airframe, which is another one

  /// Time constants of the bias that an inverse of this model learns in flight, one per sum; 0: that sum has none.
  std::optional<std::array<double, 4>> bias_time_constants_s = std::nullopt;
};

namespace detail {

/// The records of a model, as header and block state them: those of its training, and those that its types say.
struct WrittenRecords : Provenance {
  /// Limits of trust (training/structured/trust_limits.hpp), as the model's Scalar has them.
  struct Trust {
    double squared_distance_limit, residual_factor, residual_limit, residual_cleared, update_period_s;
    std::vector<double> mean, whitening;
  };

  AllocationMatrix<double> allocation{};
  ModelFacts facts{};             ///< those of the training's words that are numbers, as they are written
  std::uint32_t window_taps = 1;  ///< 1: the present alone
  bool causal = true;
  std::vector<std::string> column_names, column_units;
  std::string answer;  ///< description of what the parameters are of
  std::string base;    ///< description of the outputs' base; empty: none

  std::string name;          ///< of the header's struct
  std::string own_types;     ///< C++ of the types that it uses and that no library has; for a header
  std::string vehicle_type;  ///< for a header; empty: the airframe is written before the struct
  std::string network_type, features_type, outputs_type;  ///< as a header names them, for a reader
  std::vector<std::string> feature_texts;                 ///< name and unit of each
  std::vector<std::string> output_texts;                  ///< the schema's description, then name and unit of each
  std::string vehicle_name;
  Airframe<double> airframe{};
  std::vector<double> flown_airframe;  ///< each_number() of it in the model's Scalar
  std::vector<double> affine;          ///< of a schema of a user's own (detail::affine_schema())
  std::uint64_t contents_hash = 0;
  std::optional<Certificate> certificate{};
  std::optional<Trust> trust{};
};

/// A figure of a judgement, rounded as far as sums over the test rows are the same on every machine.
double stated_figure(double value);

/// Names and units in turn.
template <class Names, class Units>
void append_texts(std::vector<std::string>& to, const Names& names, const Units& units) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    to.emplace_back(names[i]);
    to.emplace_back(units[i]);
  }
}

/// Adds an airframe as it is and as the model's Scalar has it.
template <class Scalar>
void take_airframe(WrittenRecords& records, const std::string& name, const Airframe<double>& airframe,
                   const Airframe<Scalar>& flown) {
  records.vehicle_name = name;
  records.airframe = airframe;
  records.flown_airframe.clear();
  each_number(flown, [&](auto number) { records.flown_airframe.push_back(static_cast<double>(number)); });
  records.allocation = allocation(airframe);
}
/// The same, and the schema's own map for it.
template <class Outputs, class Scalar>
void take_airframe(WrittenRecords& records, const std::string& name, const Airframe<double>& airframe,
                   const Airframe<Scalar>& flown) {
  take_airframe(records, name, airframe, flown);
  records.affine = affine_schema<Outputs>(flown);
}

template <class M>
WrittenRecords records_of_types() {
  using Window = WindowOf<typename M::Features>;
  const auto& names = extra_column_names<typename M::Features>;
  const auto& units = extra_column_units<typename M::Features>;
  WrittenRecords records;
  records.window_taps = static_cast<std::uint32_t>(Window::taps);
  records.causal = Window::causal;
  records.column_names.assign(names.begin(), names.end());
  records.column_units.assign(units.begin(), units.end());
  records.answer = description_text<typename M::Network>();
  records.base = description_text<typename BaseOf<typename M::Outputs>::type>();
  using Map = OutputMap<typename M::Outputs>;
  append_texts(records.feature_texts, M::Features::names, M::Features::units);
  records.network_type = type_name<typename M::Network>();
  records.features_type = type_name<typename M::Features>();
  records.outputs_type = type_name<typename M::Outputs>();
  records.output_texts = {description_text<typename M::Outputs>()};
  append_texts(records.output_texts, Map::names, Map::units);
  return records;
}

/// The facts of a training for an airframe, figures rounded as they are written.
ModelFacts facts_of(const Provenance& from, const Airframe<double>& airframe);

/// Throws std::invalid_argument, one line, for facts that no model has.
void require_sound(const ModelFacts& facts);

/// Adds the facts of a training to the records of a model. Throws std::invalid_argument for facts that no model has
/// (exported/model_facts.hpp), for another period than the window's (`window_s`; 0 without one), and for a certificate
/// that proves nothing.
void take_provenance(WrittenRecords& records, const Provenance& from, double window_s);

/// The same numbers in another type.
template <class To, class Numbers>
std::vector<To> converted(const Numbers& numbers) {
  std::vector<To> result;
  for (const auto number : numbers) result.push_back(static_cast<To>(number));
  return result;
}

template <class M>
using WordsOf = std::void_t<decltype(M::name), decltype(M::training_data), decltype(M::seed), decltype(M::epochs),
                            decltype(M::loss)>;

/// The records of an exported header.
template <class M>
WrittenRecords records_of_header() {
  WrittenRecords records = records_of_types<M>();
  take_airframe<typename M::Outputs>(records, M::Vehicle::name, airframe_value<typename M::Vehicle, double>(),
                                     airframe_value<typename M::Vehicle, typename M::Scalar>());
  if constexpr (is_detected<WordsOf, M>) {
    records.name = M::name;
    records.training_data = M::training_data;
    records.seed = M::seed;
    records.epochs = M::epochs;
    records.loss = M::loss;
  }
  records.contents_hash = contents_hash_of<M>();
  records.facts = facts_of_header<M>();
  records.allocation = M::allocation;
  return records;
}

}  // namespace detail
}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/provenance.hpp"
#endif
