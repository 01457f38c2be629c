// SPDX-License-Identifier: MIT
// Writes a trained model as a C++ header that flight code includes: weights, feature schema, scaling, training
// envelope, golden vectors, provenance. Every number reads back bit for bit.
#pragma once

#include <cmath>
#include <locale>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/deploy/opening_comment.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/training/trained_model.hpp"
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
  template <class Scalar, int Size>
  void scaler(const std::string& type, const char* name, const Scaler<Scalar, Size>& value) {
    out_ << "  static constexpr pinnquad::Scaler<" << type << ", " << Size << "> " << name << " = {{";
    write_braced(out_, value.mean, "  ");
    out_ << "}, {";
    write_braced(out_, value.standard_deviation, "  ");
    out_ << "}};\n";
    count(name, value);
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

/// All numbers of a model but its golden vectors.
template <class Model>
void require_finite_model(const Model& model) {
  require_finite(model.network.parameters, "the parameters");
  require_finite(model.input.mean, "the input means");
  require_finite(model.input.standard_deviation, "the input standard deviations");
  require_finite(model.output.mean, "the output means");
  require_finite(model.output.standard_deviation, "the output standard deviations");
  require_finite(model.envelope_lower, "the lower envelope");
  require_finite(model.envelope_upper, "the upper envelope");
}

/// The commands of golden feature vectors, by the portable kernel.
/// Throws std::invalid_argument for none, for one outside the envelope, which no self test could pass, and for a model
/// or a command that is not finite.
template <class Model>
std::vector<Commands<typename Model::Scalar>> golden_commands(
    const Model& model, const std::vector<typename Model::FeatureVector>& golden) {
  if (golden.empty()) throw std::invalid_argument("export: a model needs at least one golden vector");
  require_finite_model(model);
  std::vector<Commands<typename Model::Scalar>> commands;
  for (const auto& x : golden) {
    if (!inside_envelope(model.envelope_lower.data(), x.data(), model.envelope_upper.data(), x.size())) {
      throw std::invalid_argument("export: golden vector " + std::to_string(commands.size() + 1) +
                                  " lies outside the envelope");
    }
    commands.push_back(model.predict(x));
    require_finite(commands.back(), "the commands of golden vector " + std::to_string(commands.size()));
  }
  return commands;
}

}  // namespace detail

namespace detail {

/// The header of a model into `out`; returns its contents_hash.
template <class Model>
std::uint64_t write_struct(std::ostream& out, const std::string& struct_name, const Model& model,
                           const std::vector<typename Model::FeatureVector>& golden,
                           const std::vector<Commands<typename Model::Scalar>>& golden_commands,
                           const WrittenRecords& records, const Provenance& provenance) {
  using Scalar = typename Model::Scalar;
  constexpr bool own_airframe = std::is_same_v<typename Model::Vehicle, GivenAirframe>;
  const std::string vehicle_name = model.airframe_name();
  const std::string scalar = type_name<Scalar>();
  ConstantWriter write(out);

  out << "// Inverse-dynamics model, exported by pinnquad " << PINNQUAD_VERSION
      << ". Generated: export again rather than edit.\n"
      << "// SI units, rad. Commands in the order of the airframe's rotors.\n";
  write_opening_comment(out, records, model.template airframe<double>());
  out << "#pragma once\n\n#include \"pinnquad/flight.hpp\"\n\n";
  std::string vehicle;
  if constexpr (own_airframe) {
    vehicle = struct_name + "Airframe";
    write_airframe(out, vehicle, vehicle_name, model.template airframe<double>());
    out << '\n';
  } else {
    vehicle = type_name<typename Model::Vehicle>();
  }
  out << "struct " << struct_name << " {\n"
      << "  using Scalar = " << scalar << ";\n"
      << "  using Network = " << type_name<typename Model::Network>() << ";\n"
      << "  using Features = " << type_name<typename Model::Features>() << ";\n"
      << "  using Outputs = " << type_name<typename Model::Outputs>() << ";\n"
      << "  using Vehicle = " << vehicle << ";\n"
      << "  using Inputs = Features::Inputs<Scalar>;\n\n";
  write.number("format_version", model_format_version);
  write.text("name", struct_name);
  out << "\n  // provenance\n";
  write.text("training_data", provenance.training_data);
  write.constant("std::uint64_t", "training_data_hash", hexadecimal(provenance.training_data_hash),
                 provenance.training_data_hash);
  write.constant("int", "training_rows", std::to_string(provenance.training_rows),
                 static_cast<int>(provenance.training_rows));
  out << "  static constexpr std::uint64_t seed = " << provenance.seed << "u;\n";
  write.number("epochs", provenance.epochs);
  write.text("loss", provenance.loss);
  if (provenance.verdict) {
    const Verdict& verdict = *provenance.verdict;
    const auto figure = [&](const char* name, double value) {
      if (is_finite(value)) write.number(name, stated_figure(value));
    };
    out << "\n  // how it was judged, on rows that it was not trained on: R^2, mean over the commands\n";
    figure("test_r_squared", verdict.test_r_squared);
    figure("linear_regression_r_squared", verdict.linear_regression_r_squared);
    write.truth("worse_than_mean", verdict.worse_than_mean());
    write.truth("beats_linear_regression", verdict.beats_linear_regression());
  }
  out << "\n  // what it was trained for; require_model() compares with Features, Outputs and Vehicle\n";
  write.text("frame", model_frame);
  write.list("const char*", "feature_names", Model::Features::names);
  write.list("const char*", "feature_units", Model::Features::units);
  write.list("const char*", "output_names", OutputMap<typename Model::Outputs>::names);
  write.list("const char*", "output_units", OutputMap<typename Model::Outputs>::units);
  write.text("vehicle_name", vehicle_name);
  out << "  // rotor by rotor: signs of its torque about x, y, z\n";
  write.table("int", "motor_torque_signs", motor_torque_signs(model.template airframe<double>()));
  write_header_records<Scalar>(out, write, records);
  out << "\n  // standardisation: (value - mean) / spread\n";
  write.scaler(scalar, "input", model.input);
  write.scaler(scalar, "output", model.output);
  out << "\n  // training envelope per feature, margin included\n";
  write.list(scalar, "envelope_lower", model.envelope_lower);
  write.list(scalar, "envelope_upper", model.envelope_upper);

  out << "\n  // golden vectors: features in physical units -> commands\n";
  write.table(scalar, "golden_features", golden);
  write.table(scalar, "golden_commands", golden_commands);

  out << "\n  // layer by layer: weights row-major (row = output, column = input), then biases\n";
  write.list(scalar, "parameters", model.network.parameters);
  write.count("Vehicle", model.template airframe<double>());
  out << "\n  // over all of this: what was edited does not compile (exported/contents_hash.hpp)\n"
      << "  static constexpr std::uint64_t contents_hash = " << hexadecimal(write.contents_hash()) << ";\n";
  out << "};\n\nstatic_assert(pinnquad::require_model<" << struct_name << ">());\n";
  if constexpr (has_certificate<Model>) {
    out << "static_assert(pinnquad::require_certificate<" << struct_name << ">());  // docs/certificate.md\n";
  }
  return write.contents_hash();
}

}  // namespace detail

/// Writes `struct <struct_name>` to `out`. `golden` are feature vectors inside the envelope, at least one; their
/// commands are computed here by the portable kernel. The contract of the struct: exported/model.hpp. No locale plays a
/// part. A GivenAirframe stands before the model as a struct of its own. A model that is worse than the mean says so at
/// its head. Throws std::invalid_argument, and writes nothing, for a name that no struct may have, for no golden
/// vector, for one outside the envelope, for a number that is not finite, for a provenance that no model has, and for a
/// model of proven structure that has no certificate.
template <class NetworkType, class ContextType>
void write_model(std::ostream& stream, const std::string& struct_name,
                 const TrainedModel<NetworkType, ContextType>& model,
                 const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
                 const Provenance& provenance) {
  detail::require_identifier(struct_name);
  const auto golden_commands = detail::golden_commands(model, golden);
  const auto records = detail::records_of_training(model, provenance);
  std::ostringstream out;
  out.imbue(std::locale::classic());  // a global locale may group digits
  detail::write_struct(out, struct_name, model, golden, golden_commands, records, provenance);
  stream << out.str();
}

/// The same into a file that appears whole or not at all.
template <class NetworkType, class ContextType>
void write_model_header(const std::string& path, const std::string& struct_name,
                        const TrainedModel<NetworkType, ContextType>& model,
                        const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
                        const Provenance& provenance) {
  AtomicFile file(path);
  write_model(file.stream(), struct_name, model, golden, provenance);
  file.commit();
}

}  // namespace pinnquad
