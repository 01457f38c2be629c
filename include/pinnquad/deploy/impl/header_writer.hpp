// SPDX-License-Identifier: MIT
// Bodies of header_writer.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <locale>
#include <sstream>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/opening_comment.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/version.hpp"

namespace pinnquad {
namespace detail {

/// Where a model comes from, in words and figures, and what an inverse may learn: no hash is over them.
PINNQUAD_BODY bool is_editable(std::string_view name) {
  return name == "name" || name == "training_data" || name == "epochs" || name == "loss" || name == "test_r_squared" ||
         name == "linear_regression_r_squared" || name == "bias_time_constants_s";
}

/// The constants of a struct, written one after the other, and the hash over those that count
/// (exported/contents_hash.hpp).
class ConstantWriter {
 public:
  explicit ConstantWriter(std::ostream& out) : out_(out) {}

  std::uint64_t contents_hash() const { return sum_; }
  /// Takes a value into the hash, that of a constant that may not be edited.
  template <class Value>
  void count(std::string_view name, const Value& value) {
    if (is_editable(name)) return;
    ConstantHash hash(name);
    add(hash, value);
    sum_ += hash.value();
  }

  /// `written`: the value as C++ text.
  template <class Value>
  void constant(const char* type, const char* name, const std::string& written, const Value& value) {
    out_ << "  static constexpr " << type << ' ' << name << " = " << written << ";\n";
    count(name, value);
  }
  void truth(const char* name, bool value) { constant("bool", name, value ? "true" : "false", value); }
  void number(const char* name, int value) { constant("int", name, std::to_string(value), value); }
  void number(const char* name, double value) { constant("double", name, literal(value), value); }
  void text(const char* name, const std::string& value) { constant("const char*", name, quoted(value), value); }
  template <class Values>
  void list(const std::string& type, const char* name, const Values& values) {
    out_ << "  static constexpr std::array<" << type << ", " << values.size() << "> " << name << " = ";
    if (values.size() == 0) {
      out_ << "{};\n";
    } else {
      out_ << '{';
      write_braced(out_, values, "  ");
      out_ << "};\n";
    }
    count(name, values);
  }
  template <class Rows>
  void table(const std::string& type, const char* name, const Rows& rows) {
    out_ << "  static constexpr std::array<std::array<" << type << ", " << rows[0].size() << ">, " << rows.size()
         << "> " << name << " = {{";
    for (std::size_t i = 0; i < rows.size(); ++i) {
      out_ << (i == 0 ? "\n    {" : ",\n    {");
      write_braced(out_, rows[i], "    ");
      out_ << '}';
    }
    out_ << "}};\n";
    count(name, rows);
  }
  template <class Scalar>
  void scaler(const std::string& type, const char* name, const std::vector<Scalar>& mean,
              const std::vector<Scalar>& standard_deviation) {
    out_ << "  static constexpr pinnquad::Scaler<" << type << ", " << mean.size() << "> " << name << " = {{";
    write_braced(out_, mean, "  ");
    out_ << "}, {";
    write_braced(out_, standard_deviation, "  ");
    out_ << "}};\n";
    count(name, std::array{mean, standard_deviation});
  }

 private:
  template <class Value>
  using ElementOf = decltype(*std::declval<const Value&>().begin());
  template <class Value>
  static void add(ConstantHash& hash, const Value& value) {
    if constexpr (std::is_convertible_v<Value, std::string_view>) {
      hash.add(std::string_view(printable(std::string(value))));
    } else if constexpr (is_detected<ElementOf, Value>) {
      for (const auto& one : value) add(hash, one);
    } else {
      hash.add(value);
    }
  }

  std::ostream& out_;
  std::uint64_t sum_ = 0;
};

/// Takes into the hash what the types of a header say.
PINNQUAD_BODY void count_types(ConstantWriter& write, const WrittenRecords& model) {
  const auto features = names_and_units(model.feature_texts, 0);
  const auto outputs = names_and_units(model.output_texts, 1);  // behind the schema's description
  write.count("frame", std::string(model_frame));
  write.count("feature_names", features.names);
  write.count("feature_units", features.units);
  write.count("output_names", outputs.names);
  write.count("output_units", outputs.units);
  write.count("vehicle_name", model.vehicle_name);
  write.count("motor_torque_signs", motor_torque_signs(model.airframe));
  write.count("Vehicle", model.airframe);
  write.count("records", known_records);
  write.count("answer", model.answer);
  write.count("window_taps", static_cast<int>(model.window_taps));
  write.count("causal", model.causal);
  write.count("column_names", model.column_names);
  write.count("column_units", model.column_units);
  write.count("base", model.base);
}

/// "s_z [m/s^2], wdot_x [rad/s^2]".
PINNQUAD_BODY std::string in_words(const std::vector<std::string>& texts, std::size_t first) {
  std::string words;
  for (std::size_t i = first; i + 1 < texts.size(); i += 2) {
    words += (i == first ? "" : ", ") + texts[i] + " [" + texts[i + 1] + "]";
  }
  std::replace(words.begin(), words.end(), '\\', '/');  // at the end of a line it would go on
  return printable(words);
}

template <class Scalar>
std::uint64_t write_struct(std::ostream& out, const WrittenModel<Scalar>& model) {
  const std::string scalar = type_name<Scalar>();
  ConstantWriter write(out);

  out << "// Inverse-dynamics model, exported by pinnquad " << PINNQUAD_VERSION
      << ". Generated: export again rather than edit.\n"
      << "// SI units, rad. Commands in the order of the airframe's rotors.\n";
  write_opening_comment(out, model, model.airframe);
  out << "#pragma once\n\n" << flight_include << '\n' << model.own_types;
  std::string vehicle = model.vehicle_type;
  if (vehicle.empty()) {
    vehicle = model.name + "Airframe";
    write_airframe(out, vehicle, model.vehicle_name, model.airframe);
    out << '\n';
  }
  write_comment(out, "Features: " + in_words(model.feature_texts, 0) + ".");
  write_comment(out, "Outputs: " + in_words(model.output_texts, 1) + ".");
  out << "struct " << model.name << " {\n"
      << "  using Scalar = " << scalar << ";\n"
      << "  using Network = " << model.network_type << ";\n"
      << "  using Features = " << model.features_type << ";\n"
      << "  using Outputs = " << model.outputs_type << ";\n"
      << "  using Vehicle = " << vehicle << ";\n"
      << "  using Inputs = Features::Inputs<Scalar>;\n\n";
  out << "  static constexpr int format_version = " << header_format_version << ";\n";
  write.count("format_version", contents_format);
  write.text("name", model.name);
  out << "\n  // provenance\n";
  write.text("training_data", model.training_data);
  write.constant("std::uint64_t", "training_data_hash", hexadecimal(model.training_data_hash),
                 model.training_data_hash);
  write.constant("int", "training_rows", std::to_string(model.training_rows), static_cast<int>(model.training_rows));
  out << "  static constexpr std::uint64_t seed = " << model.seed << "u;\n";
  write.number("epochs", model.epochs);
  write.text("loss", model.loss);
  const ModelFacts& facts = model.facts;
  if (facts.has_verdict) {
    out << "\n  // how it was judged, on rows that it was not trained on: R^2, mean over the commands\n";
    if (facts.has_r_squared) write.number("test_r_squared", facts.test_r_squared);
    if (facts.linear_regression_r_squared > -no_bound) {
      write.number("linear_regression_r_squared", facts.linear_regression_r_squared);
    }
    write.truth("worse_than_mean", facts.worse_than_mean);
    write.truth("beats_linear_regression", facts.beats_linear_regression);
  }
  out << "\n  // commands and clock of its training (exported/model_facts.hpp)\n";
  write.constant("auto", "command_meaning",
                 std::string("pinnquad::CommandMeaning::") + to_string(facts.command_meaning), facts.command_meaning);
  write.number("command_lower", facts.command_lower);
  write.number("command_upper", facts.command_upper);
  write.number("sample_period_s", facts.sample_period_s);
  write.number("lag_removed_s", facts.lag_removed_s);
  out << "  // thrust [N], roll, pitch and yaw torque [N m] of each rotor at full command, rated density\n";
  write.table("double", "allocation", model.allocation);
  if (facts.has_bias) {
    out << "  // of the bias that is learnt in flight (control/motion_bias.hpp): sum of the commands, roll, pitch, "
           "yaw\n";
    write.list(scalar, "bias_time_constants_s",
               std::array{static_cast<Scalar>(facts.bias_time_constants_s[0]),
                          static_cast<Scalar>(facts.bias_time_constants_s[1]),
                          static_cast<Scalar>(facts.bias_time_constants_s[2]),
                          static_cast<Scalar>(facts.bias_time_constants_s[3])});
  }
  out << "\n  // standardisation: (value - mean) / spread\n";
  write.scaler(scalar, "input", model.input_mean, model.input_deviation);
  write.scaler(scalar, "output", model.output_mean, model.output_deviation);
  out << "\n  // training envelope per feature, margin included\n";
  write.list(scalar, "envelope_lower", model.envelope_lower);
  write.list(scalar, "envelope_upper", model.envelope_upper);

  out << "\n  // golden vectors: features in physical units -> commands\n";
  write.table(scalar, "golden_features", model.golden_features);
  write.table(scalar, "golden_commands", model.golden_commands);

  out << "\n  // layer by layer: weights row-major (row = output, column = input), then biases\n";
  write.list(scalar, "parameters", model.parameters);
  count_types(write, model);
  out << "\n  // over what the types say: layers, names and units, frame, airframe's name, motor order\n"
      << "  static constexpr std::uint64_t shape_hash = " << hexadecimal(hash_of_shape(model)) << ";\n"
      << "  // over all of this: what was edited does not compile (exported/contents_hash.hpp)\n"
      << "  static constexpr std::uint64_t contents_hash = " << hexadecimal(write.contents_hash()) << ";\n";
  out << "};\n\nstatic_assert(pinnquad::require_model<" << model.name << ">());\n";
  if (model.certificate) {
    out << "static_assert(pinnquad::require_certificate<" << model.name << ">());  // docs/certificate.md\n";
  }
  return write.contents_hash();
}

template <class Scalar>
std::string header_text(const WrittenModel<Scalar>& model) {
  std::ostringstream out;
  out.imbue(std::locale::classic());  // a global locale may group digits
  write_struct(out, model);
  return out.str();
}

}  // namespace detail

template <class Scalar>
void write_model(std::ostream& stream, const std::string& struct_name, const GroundModel<Scalar>& model,
                 const std::vector<std::vector<double>>& golden, const Provenance& provenance) {
  detail::require_identifier(struct_name);
  stream << detail::header_text(detail::written_model(model, golden, provenance, struct_name));
}
#ifdef PINNQUAD_COMPILED
template std::uint64_t detail::write_struct(std::ostream&, const detail::WrittenModel<float>&);
template std::uint64_t detail::write_struct(std::ostream&, const detail::WrittenModel<double>&);
template std::string detail::header_text(const detail::WrittenModel<float>&);
template std::string detail::header_text(const detail::WrittenModel<double>&);
template void write_model(std::ostream&, const std::string&, const GroundModel<float>&,
                          const std::vector<std::vector<double>>&, const Provenance&);
template void write_model(std::ostream&, const std::string&, const GroundModel<double>&,
                          const std::vector<std::vector<double>>&, const Provenance&);
#endif

}  // namespace pinnquad
