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
#include "pinnquad/deploy/block_writer.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {

namespace detail {

/// 3 x 4 numbers of a header, rotor by rotor.
inline pinnquad::detail::TorqueSigns signs_of(const HeaderFile& header, const std::string& name) {
  const std::vector<double> numbers = header.numbers(name, 3 * pinnquad::rotor_count);
  pinnquad::detail::TorqueSigns signs{};
  for (std::size_t i = 0; i < numbers.size(); ++i) signs[i / 3][i % 3] = static_cast<int>(numbers[i]);
  return signs;
}

/// Adds the records that a header of any format may have.
inline void take_optional_records(const HeaderFile& header, pinnquad::detail::WrittenRecords& records) {
  if (header.has("worse_than_mean") && header.has("beats_linear_regression")) {
    records.judged =
        pinnquad::detail::judged_bits(header.truth("worse_than_mean"), header.truth("beats_linear_regression"));
  }
  if (header.has("slope_signs")) records.slope_signs = signs_of(header, "slope_signs");
  if (header.has("residual_lower")) {
    records.residual_range = {header.numbers("residual_lower"), header.numbers("residual_upper")};
  }
  if (header.has("distance_mean")) {
    records.distance = {header.numbers("distance_mean"), header.numbers("distance_inverse_cholesky"),
                        header.number("distance_limit")};
  }
}

/// Of a header of format 3, which says all of it.
inline pinnquad::detail::WrittenRecords stated_records(const HeaderFile& header) {
  pinnquad::detail::WrittenRecords records;
  records.answer = header.quoted("answer");
  std::string meaning = header.text("command_meaning");
  if (meaning == "pinnquad::CommandMeaning::pulse_width") meaning = "pinnquad::CommandMeaning::throttle";
  bool known = false;
  for (const pinnquad::CommandMeaning one :
       {pinnquad::CommandMeaning::thrust, pinnquad::CommandMeaning::throttle, pinnquad::CommandMeaning::speed}) {
    if (meaning != std::string("pinnquad::CommandMeaning::") + pinnquad::to_string(one)) continue;
    records.command_meaning = one;
    known = true;
  }
  if (!known) header.refuse("command_meaning", "a meaning of commands", "`" + pinnquad::printable(meaning) + "`");
  for (const std::string& record : header.texts("records")) {
    if (std::find(pinnquad::known_records.begin(), pinnquad::known_records.end(), record) ==
        pinnquad::known_records.end()) {
      header.refuse("records", "records that are known", "`" + pinnquad::printable(record) + "`");
    }
  }
  records.command_lower = header.number("command_lower");
  records.command_upper = header.number("command_upper");
  records.sample_period_s = header.number("sample_period_s");
  records.lag_removed_s = header.number("lag_removed_s");
  for (const char* time : {"sample_period_s", "lag_removed_s"}) {
    if (pinnquad::is_clock_time(header.number(time))) continue;
    header.refuse(time, "a time of 0 to 4 s", pinnquad::number_text(header.number(time)));
  }
  records.window_taps = static_cast<std::uint32_t>(header.number("window_taps"));
  records.causal = header.truth("causal");
  records.column_names = header.texts("column_names");
  records.column_units = header.texts("column_units");
  if (records.column_names.size() != records.column_units.size()) {
    header.refuse("column_units", "a unit for each column", std::to_string(records.column_units.size()));
  }
  const std::vector<double> allocation = header.numbers("allocation", 16);
  for (std::size_t i = 0; i < allocation.size(); ++i) records.allocation[i / 4][i % 4] = allocation[i];
  records.base = header.texts("base").empty() ? "" : header.quoted("base");
  return records;
}

/// Of a header of format 2: what its types imply, where they are the library's.
inline pinnquad::detail::WrittenRecords implied_records(const HeaderFile& header) {
  pinnquad::detail::WrittenRecords records;
  records.answer = header.text("Network");
  const std::string before = "pinnquad::InputSize<", now = "pinnquad::Inputs<";  // its name in descriptions
  const std::size_t inputs = records.answer.find(before);
  if (inputs != std::string::npos) records.answer.replace(inputs, before.size(), now);
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
  records.command_meaning = pinnquad::command_meaning_of(airframe);
  records.allocation = pinnquad::allocation(airframe);
  return records;
}

/// The hash by which a reader knows the block's shape (pinnquad::detail::hash_of_shape), from the texts of the header.
inline std::uint64_t shape_hash_of(const HeaderFile& header, const std::string& answer) {
  pinnquad::detail::Fnv1a fnv;
  fnv.absorb_text(answer);
  pinnquad::detail::absorb_shape(fnv, header.texts("feature_names"), header.texts("feature_units"),
                                 header.texts("output_names"),
                                 header.texts(header.has("output_units") ? "output_units" : "output_unit"),
                                 header.quoted("vehicle_name"), signs_of(header, "motor_torque_signs"));
  return fnv.hash;
}

inline pinnquad::detail::WrittenRecords records_of(const HeaderFile& header) {
  const auto format = static_cast<int>(header.number("format_version"));
  constexpr int oldest = 2;  // format 1 does not check its own names
  if (format < oldest || format > pinnquad::model_format_version) {
    header.refuse("format_version", "format 2 to " + std::to_string(pinnquad::model_format_version),
                  std::to_string(format));
  }
  if (header.quoted("frame") != pinnquad::model_frame) {
    header.refuse("frame", std::string("the frame `") + pinnquad::model_frame + "`",
                  "`" + pinnquad::printable(header.quoted("frame")) + "`");
  }
  pinnquad::detail::WrittenRecords records = format == oldest ? implied_records(header) : stated_records(header);
  take_optional_records(header, records);
  return records;
}

template <class Scalar>
std::vector<unsigned char> block_of(const HeaderFile& header) {
  const pinnquad::detail::WrittenRecords records = records_of(header);
  const std::size_t inputs = header.texts("feature_names").size(), outputs = header.texts("output_names").size();
  const std::vector<double> golden_features = header.numbers("golden_features"),
                            parameters = header.numbers("parameters");
  const std::size_t golden = inputs == 0 ? 0 : golden_features.size() / inputs;
  if (inputs == 0 || outputs == 0 || golden * inputs != golden_features.size() || golden == 0) {
    header.refuse("golden_features", "whole vectors of features", std::to_string(golden_features.size()) + " numbers");
  }
  pinnquad::detail::LittleEndianBytes<Scalar> scalars;
  scalars.add(header.numbers("input", 2 * inputs));
  scalars.add(header.numbers("output", 2 * outputs));
  scalars.add(header.numbers("envelope_lower", inputs));
  scalars.add(header.numbers("envelope_upper", inputs));
  scalars.add(golden_features);
  scalars.add(header.numbers("golden_commands", golden * pinnquad::rotor_count));
  scalars.add(parameters);
  return pinnquad::detail::whole_block(
      {sizeof(Scalar), inputs, outputs, parameters.size(), golden,
       static_cast<std::uint64_t>(header.number("training_rows")), shape_hash_of(header, records.answer),
       header.hexadecimal("training_data_hash")},
      pinnquad::detail::block_records<Scalar>(records), scalars.bytes);
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
inline std::string answer_of(const HeaderFile& header) { return detail::records_of(header).answer; }

}  // namespace programs
