// SPDX-License-Identifier: MIT
// Bodies of header_writer.hpp.
#pragma once

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

/// The constants of a struct, written one after the other, and the hash over those that count
/// (exported/contents_hash.hpp).
class ConstantWriter {
 public:
  explicit ConstantWriter(std::ostream& out) : out_(out) {}

  std::uint64_t contents_hash() const { return sum_; }
  /// Takes into the hash a value that is no constant.
  template <class Value>
  void count(std::string_view name, const Value& value) {
    if (!is_hashed(name)) return;
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
    if constexpr (std::is_convertible_v<Value, std::string>) {
      hash.add(std::string_view(printable(value)));
    } else if constexpr (is_detected<ElementOf, Value>) {
      for (const auto& one : value) add(hash, one);
    } else {
      hash.add(value);
    }
  }

  std::ostream& out_;
  std::uint64_t sum_ = 0;
};

/// Writes the records of a header into a struct, whose texts around them are `out`'s.
template <class Scalar>
void write_header_records(std::ostream& out, ConstantWriter& write, const WrittenRecords& records) {
  const std::string scalar = std::is_same_v<Scalar, float> ? "float" : "double";
  out << "\n  // records: a reader that does not know one of them must not fly the model "
         "(exported/model_records.hpp)\n";
  std::vector<std::string> names;
  for (const std::string_view record : known_records) names.emplace_back(record);
  write.list("const char*", "records", names);
  write.text("answer", records.answer);
  write.constant("auto", "command_meaning",
                 std::string("pinnquad::CommandMeaning::") + to_string(*records.command_meaning),
                 *records.command_meaning);
  write.number("command_lower", records.command_lower);
  write.number("command_upper", records.command_upper);
  write.number("sample_period_s", records.sample_period_s);
  write.number("lag_removed_s", records.lag_removed_s);
  write.number("window_taps", static_cast<int>(records.window_taps));
  write.truth("causal", records.causal);
  write.list("const char*", "column_names", records.column_names);
  write.list("const char*", "column_units", records.column_units);
  out << "  // thrust [N], roll, pitch and yaw torque [N m] of each rotor at full command, rated density\n";
  write.table("double", "allocation", records.allocation);
  write.text("base", records.base);
  if (records.slope_signs) write.table("int", "slope_signs", *records.slope_signs);
  if (records.residual_range) {
    write.list(scalar, "residual_lower", converted<Scalar>(records.residual_range->lower));
    write.list(scalar, "residual_upper", converted<Scalar>(records.residual_range->upper));
  }
  if (records.distance) {
    write.list(scalar, "distance_mean", converted<Scalar>(records.distance->mean));
    write.list(scalar, "distance_inverse_cholesky", converted<Scalar>(records.distance->inverse_cholesky));
    const auto limit = static_cast<Scalar>(records.distance->limit);
    write.constant(scalar.c_str(), "distance_limit", literal(limit), limit);
  }
  if (records.bias_time_constants_s) {
    out << "  // of the bias that is learnt in flight (control/motion_bias.hpp): sum of the commands, roll, pitch, "
           "yaw\n";
    write.list(scalar, "bias_time_constants_s", converted<Scalar>(*records.bias_time_constants_s));
  }
}

template <class Scalar>
std::uint64_t write_struct(std::ostream& out, const WrittenModel<Scalar>& model) {
  const std::string scalar = type_name<Scalar>();
  const auto signs = motor_torque_signs(model.airframe);
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
  out << "struct " << model.name << " {\n"
      << "  using Scalar = " << scalar << ";\n"
      << "  using Network = " << model.network_type << ";\n"
      << "  using Features = " << model.features_type << ";\n"
      << "  using Outputs = " << model.outputs_type << ";\n"
      << "  using Vehicle = " << vehicle << ";\n"
      << "  using Inputs = Features::Inputs<Scalar>;\n\n";
  write.number("format_version", model_format_version);
  write.text("name", model.name);
  out << "\n  // provenance\n";
  write.text("training_data", model.training_data);
  write.constant("std::uint64_t", "training_data_hash", hexadecimal(model.training_data_hash),
                 model.training_data_hash);
  write.constant("int", "training_rows", std::to_string(model.training_rows), static_cast<int>(model.training_rows));
  out << "  static constexpr std::uint64_t seed = " << model.seed << "u;\n";
  write.number("epochs", model.epochs);
  write.text("loss", model.loss);
  if (model.verdict) {
    const Verdict& verdict = *model.verdict;
    const auto figure = [&](const char* name, double value) {
      if (is_finite(value)) write.number(name, stated_figure(value));
    };
    out << "\n  // how it was judged, on rows that it was not trained on: R^2, mean over the commands\n";
    figure("test_r_squared", verdict.test_r_squared);
    figure("linear_regression_r_squared", verdict.linear_regression_r_squared);
    write.truth("worse_than_mean", verdict.worse_than_mean());
    write.truth("beats_linear_regression", verdict.beats_linear_regression());
  }
  const auto features = names_and_units(model.feature_texts, 0);
  const auto outputs = names_and_units(model.output_texts, 1);  // behind the schema's description
  out << "\n  // what it was trained for; require_model() compares with Features, Outputs and Vehicle\n";
  write.text("frame", model_frame);
  write.list("const char*", "feature_names", features.names);
  write.list("const char*", "feature_units", features.units);
  write.list("const char*", "output_names", outputs.names);
  write.list("const char*", "output_units", outputs.units);
  write.text("vehicle_name", model.vehicle_name);
  out << "  // rotor by rotor: signs of its torque about x, y, z\n";
  write.table("int", "motor_torque_signs", signs);
  write_header_records<Scalar>(out, write, model);
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
  write.count("Vehicle", model.airframe);
  out << "\n  // over all of this: what was edited does not compile (exported/contents_hash.hpp)\n"
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
