// SPDX-License-Identifier: MIT
// An exported header as a model block, from its text: the bytes that its training would have written
// (deploy/weight_file.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "airframe/choice.hpp"
#include "model/header_file.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/inference/model_block.hpp"

namespace programs {

namespace detail {

using Bytes = pinnquad::detail::LittleEndianBytes;

/// What a block says beyond its scalars.
struct HeaderTerms {
  std::string answer;
  pinnquad::CommandMeaning command_meaning = pinnquad::CommandMeaning::thrust;
  double command_lower = 0, command_upper = 1;
  double sample_period_s = 0, lag_removed_s = 0;
  std::uint32_t window_taps = 1, causal = 1;
  std::vector<std::string> column_names, column_units;
  std::vector<double> allocation;
  std::string base;
};

/// Of a header of format 3, which says all of it.
inline HeaderTerms stated_terms(const HeaderFile& header) {
  HeaderTerms terms;
  terms.answer = header.quoted("answer");
  const std::string& meaning = header.text("command_meaning");
  bool known = false;
  for (const pinnquad::CommandMeaning one :
       {pinnquad::CommandMeaning::thrust, pinnquad::CommandMeaning::pulse_width, pinnquad::CommandMeaning::speed}) {
    if (meaning != std::string("pinnquad::CommandMeaning::") + pinnquad::to_string(one)) continue;
    terms.command_meaning = one;
    known = true;
  }
  if (!known) header.refuse("command_meaning", "a meaning of commands", "`" + pinnquad::printable(meaning) + "`");
  for (const std::string& record : header.texts("records")) {
    if (std::find(pinnquad::known_records.begin(), pinnquad::known_records.end(), record) ==
        pinnquad::known_records.end()) {
      header.refuse("records", "records that are known", "`" + pinnquad::printable(record) + "`");
    }
  }
  terms.command_lower = header.number("command_lower");
  terms.command_upper = header.number("command_upper");
  terms.sample_period_s = header.number("sample_period_s");
  terms.lag_removed_s = header.number("lag_removed_s");
  terms.window_taps = static_cast<std::uint32_t>(header.number("window_taps"));
  terms.causal = header.truth("causal") ? 1 : 0;
  terms.column_names = header.texts("column_names");
  terms.column_units = header.texts("column_units");
  if (terms.column_names.size() != terms.column_units.size()) {
    header.refuse("column_units", "a unit for each column", std::to_string(terms.column_units.size()));
  }
  terms.allocation = header.numbers("allocation", 16);
  terms.base = header.texts("base").empty() ? "" : header.quoted("base");
  return terms;
}

/// Of a header of format 2: what its types imply, where they are the library's.
inline HeaderTerms implied_terms(const HeaderFile& header) {
  HeaderTerms terms;
  terms.answer = header.text("Network");
  const std::string before = "pinnquad::InputSize<", now = "pinnquad::Inputs<";  // its name in descriptions
  const std::size_t inputs = terms.answer.find(before);
  if (inputs != std::string::npos) terms.answer.replace(inputs, before.size(), now);
  const std::string& features = header.text("Features");
  if (features != "pinnquad::PaperFeatures" && features != "pinnquad::PaperFeaturesWithAltitude") {
    header.refuse("Features", "a feature set of the library in a header of format 2",
                  "`" + pinnquad::printable(features) + "`");
  }
  const std::string& outputs = header.text("Outputs");
  if (outputs != "pinnquad::CommandOutputs" && outputs != "pinnquad::RotorSpeedOutputs") {
    header.refuse("Outputs", "an output schema of the library in a header of format 2",
                  "`" + pinnquad::printable(outputs) + "`");
  }
  const pinnquad::Airframe<double> airframe = chosen_airframe(header.quoted("vehicle_name")).value;
  terms.command_meaning = pinnquad::command_meaning_of(airframe);
  for (const auto& row : allocation(airframe)) terms.allocation.insert(terms.allocation.end(), row.begin(), row.end());
  return terms;
}

/// The hash by which a reader knows the block's shape (pinnquad::detail::hash_of_shape), from the texts of the header.
inline std::uint64_t shape_hash_of(const HeaderFile& header, const std::string& answer, bool one_unit_is_stated) {
  pinnquad::detail::Fnv1a fnv;
  fnv.absorb_text(answer);
  fnv.absorb_text(pinnquad::model_frame);
  for (const char* list : {"feature_names", "feature_units", "output_names"}) {
    for (const std::string& text : header.texts(list)) fnv.absorb_text(text);
  }
  std::vector<std::string> units = header.texts(one_unit_is_stated ? "output_unit" : "output_units");
  if (!units.empty() && std::count(units.begin(), units.end(), units.front()) == std::int64_t(units.size())) {
    units.resize(1);
  }
  for (const std::string& unit : units) fnv.absorb_text(unit);
  fnv.absorb_text(header.quoted("vehicle_name"));
  for (const double sign : header.numbers("motor_torque_signs", 3 * pinnquad::rotor_count)) {
    fnv.absorb(static_cast<unsigned char>(static_cast<int>(sign) + 1));
  }
  return fnv.hash;
}

/// The records in the order of pinnquad::detail::block_records().
template <class Scalar>
std::vector<unsigned char> records_of(const HeaderFile& header, const HeaderTerms& terms) {
  Bytes out;
  std::uint32_t count = 0;
  const auto record = [&](pinnquad::BlockRecord type, bool mandatory, const Bytes& body) {
    out.add_unsigned(
        static_cast<std::uint16_t>(static_cast<unsigned>(type) | (mandatory ? pinnquad::mandatory_record : 0u)));
    out.add_unsigned(std::uint16_t{0});
    out.add_unsigned(static_cast<std::uint32_t>(body.bytes.size()));
    out.bytes.insert(out.bytes.end(), body.bytes.begin(), body.bytes.end());
    out.bytes.resize(pinnquad::BlockRecordLayout::padded(out.bytes.size()), 0);  // heads and bodies: multiples of 8
    ++count;
  };
  const auto scalars = [](Bytes& to, const std::vector<double>& values) {
    for (const double value : values) to.add(static_cast<Scalar>(value));
  };
  Bytes commands, clock, window, columns, allocation, base, verdict;
  commands.add_unsigned(static_cast<std::uint32_t>(terms.command_meaning));
  commands.add_unsigned(std::uint32_t{0});
  scalars(commands, {terms.command_lower, terms.command_upper});
  record(pinnquad::BlockRecord::commands, true, commands);
  clock.add_unsigned(pinnquad::detail::nanoseconds(terms.sample_period_s));
  clock.add_unsigned(pinnquad::detail::nanoseconds(terms.lag_removed_s));
  record(pinnquad::BlockRecord::clock, true, clock);
  window.add_unsigned(terms.window_taps);
  window.add_unsigned(terms.causal);
  record(pinnquad::BlockRecord::window, true, window);
  for (std::size_t i = 0; i < terms.column_names.size(); ++i) {
    columns.add_text(terms.column_names[i]);
    columns.add_text(terms.column_units[i]);
  }
  if (!columns.bytes.empty()) record(pinnquad::BlockRecord::columns, true, columns);
  scalars(allocation, terms.allocation);
  record(pinnquad::BlockRecord::allocation, true, allocation);
  base.bytes.assign(terms.base.begin(), terms.base.end());
  if (!base.bytes.empty()) record(pinnquad::BlockRecord::base, true, base);
  if (header.has("worse_than_mean") && header.has("beats_linear_regression")) {
    verdict.add_unsigned((header.truth("worse_than_mean") ? pinnquad::Judged::worse_than_mean : 0u) |
                         (header.truth("beats_linear_regression") ? pinnquad::Judged::beats_linear_regression : 0u));
    verdict.add_unsigned(std::uint32_t{0});
    record(pinnquad::BlockRecord::verdict, false, verdict);
  }
  if (header.has("slope_signs")) {
    Bytes signs;
    for (const double sign : header.numbers("slope_signs", 3 * pinnquad::rotor_count)) {
      signs.bytes.push_back(static_cast<unsigned char>(static_cast<int>(sign)));
    }
    record(pinnquad::BlockRecord::slope_signs, false, signs);
  }
  if (header.has("residual_lower")) {
    Bytes range;
    scalars(range, header.numbers("residual_lower"));
    scalars(range, header.numbers("residual_upper"));
    record(pinnquad::BlockRecord::residual_range, false, range);
  }
  if (header.has("distance_mean")) {
    Bytes distance;
    for (const char* name : {"distance_mean", "distance_inverse_cholesky", "distance_limit"}) {
      scalars(distance, header.numbers(name));
    }
    record(pinnquad::BlockRecord::distance, false, distance);
  }
  Bytes all;
  all.add_unsigned(count);
  all.add_unsigned(static_cast<std::uint32_t>(out.bytes.size()));
  all.bytes.insert(all.bytes.end(), out.bytes.begin(), out.bytes.end());
  return std::move(all.bytes);
}

inline HeaderTerms terms_of(const HeaderFile& header) {
  const auto format = static_cast<int>(header.number("format_version"));
  constexpr int oldest = 2;  // format 1 does not check its own names
  if (format < oldest || format > pinnquad::model_format_version) {
    header.refuse("format_version", "format 2 to " + std::to_string(pinnquad::model_format_version),
                  std::to_string(format));
  }
  return format == oldest ? implied_terms(header) : stated_terms(header);
}

template <class Scalar>
std::vector<unsigned char> block_of(const HeaderFile& header) {
  const HeaderTerms terms = terms_of(header);
  const std::size_t inputs = header.texts("feature_names").size(), outputs = header.texts("output_names").size();
  const std::vector<double> golden_features = header.numbers("golden_features"),
                            parameters = header.numbers("parameters");
  const std::size_t golden = inputs == 0 ? 0 : golden_features.size() / inputs;
  if (inputs == 0 || outputs == 0 || golden * inputs != golden_features.size() || golden == 0) {
    header.refuse("golden_features", "whole vectors of features", std::to_string(golden_features.size()) + " numbers");
  }
  const std::vector<unsigned char> records = records_of<Scalar>(header, terms);
  Bytes body;
  const auto scalars = [&body](const std::vector<double>& values) {
    for (const double value : values) body.add(static_cast<Scalar>(value));
  };
  scalars(header.numbers("input", 2 * inputs));
  scalars(header.numbers("output", 2 * outputs));
  scalars(header.numbers("envelope_lower", inputs));
  scalars(header.numbers("envelope_upper", inputs));
  scalars(golden_features);
  scalars(header.numbers("golden_commands", golden * pinnquad::rotor_count));
  scalars(parameters);

  Bytes out;
  for (const unsigned char byte : pinnquad::model_block_magic) out.bytes.push_back(byte);
  out.add_unsigned(pinnquad::model_block_version);
  const std::size_t length =
      pinnquad::ModelBlockHeader::size + records.size() + body.bytes.size() + pinnquad::ModelBlockHeader::checksum_size;
  for (const std::size_t count : {length, sizeof(Scalar), inputs, outputs, parameters.size(), golden,
                                  static_cast<std::size_t>(header.number("training_rows"))}) {
    out.add_unsigned(static_cast<std::uint32_t>(count));
  }
  out.add_unsigned(shape_hash_of(header, terms.answer, !header.has("output_units")));
  out.add_unsigned(header.hexadecimal("training_data_hash"));
  out.bytes.insert(out.bytes.end(), records.begin(), records.end());
  out.bytes.insert(out.bytes.end(), body.bytes.begin(), body.bytes.end());
  out.add_unsigned(pinnquad::crc32(out.bytes.data(), out.bytes.size()));
  return std::move(out.bytes);
}

}  // namespace detail

/// Throws InputError where the header says what no block holds.
inline std::vector<unsigned char> block_of(const HeaderFile& header) {
  const std::string& scalar = header.text("Scalar");
  if (scalar != "float" && scalar != "double") {
    header.refuse("Scalar", "float or double", "`" + pinnquad::printable(scalar) + "`");
  }
  return scalar == "float" ? detail::block_of<float>(header) : detail::block_of<double>(header);
}

/// The network as a description; what a block only hashes.
inline std::string answer_of(const HeaderFile& header) { return detail::terms_of(header).answer; }

}  // namespace programs
