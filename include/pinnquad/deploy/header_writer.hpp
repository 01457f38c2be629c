// SPDX-License-Identifier: MIT
// Writes a trained model as a C++ header that flight code includes: weights, feature schema, scaling, training
// envelope, golden vectors, provenance. Every number reads back bit for bit.
#pragma once

#include <cctype>
#include <charconv>
#include <cstdint>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/atomic_file.hpp"
#include "pinnquad/deploy/type_name.hpp"
#include "pinnquad/inference/model.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/version.hpp"

namespace pinnquad {

/// Where a model comes from; printed into the header as strings.
struct Provenance {
  std::string training_data;             ///< name of the flight, not a path of the machine
  std::uint64_t training_data_hash = 0;  ///< content_hash() of the flight
  std::size_t training_rows = 0;
  std::uint64_t seed = 0;
  int epochs = 0;
  std::string loss;  ///< in words
};

namespace detail {

/// Shortest text that reads back as the same value, marked as a literal of its type.
inline std::string literal(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string result(text, end);
  if (result.find_first_of(".en") == std::string::npos) result += ".0";
  return result + "f";
}
inline std::string literal(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string result(text, end);
  if (result.find_first_of(".en") == std::string::npos) result += ".0";
  return result;
}

inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
  }
  return result + '"';
}
inline std::string literal(const char* text) { return quoted(text); }
inline std::string literal(int value) { return std::to_string(value); }

/// Values in braces, several to a line.
template <class Range>
void write_braced(std::ostream& out, const Range& values, const std::string& indent) {
  constexpr int per_line = 8;
  out << '{';
  int column = 0;
  bool first = true;
  for (const auto& value : values) {
    if (!first) out << ',';
    if (column == 0 && values.size() > per_line) out << '\n' << indent << "    ";
    if (column != 0 || (values.size() <= per_line && !first)) out << ' ';
    out << literal(value);
    first = false;
    column = (column + 1) % per_line;
  }
  out << '}';
}

inline std::string hexadecimal(std::uint64_t value) {
  char text[17];
  const auto end = std::to_chars(text, text + 16, value, 16).ptr;
  const std::string digits(text, end);
  return "0x" + std::string(16 - digits.size(), '0') + digits;
}

/// The commands of golden feature vectors, by the portable kernel.
/// Throws std::invalid_argument for none, and for one outside the envelope: no self test could pass it.
template <class Model>
std::vector<Commands<typename Model::Scalar>> golden_commands(
    const Model& model, const std::vector<typename Model::FeatureVector>& golden) {
  if (golden.empty()) throw std::invalid_argument("export: a model needs at least one golden vector");
  std::vector<Commands<typename Model::Scalar>> commands;
  for (const auto& x : golden) {
    if (!between(model.envelope_lower, x, model.envelope_upper)) {
      throw std::invalid_argument("export: golden vector " + std::to_string(commands.size() + 1) +
                                  " lies outside the envelope");
    }
    commands.push_back(model.predict(x));
  }
  return commands;
}

}  // namespace detail

/// True for a name that a struct may have.
inline bool is_identifier(const std::string& name) {
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) return false;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') return false;
  }
  return true;
}

/// Writes `struct <struct_name>` to `out`. `golden` are feature vectors inside the envelope, at least one; their
/// commands are computed here by the portable kernel. The contract of what is written: inference/model.hpp. Throws
/// std::invalid_argument for a name that is no identifier, for no golden vector, and for one outside the envelope.
template <class NetworkType, class ContextType>
void write_model(std::ostream& out, const std::string& struct_name, const TrainedModel<NetworkType, ContextType>& model,
                 const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
                 const Provenance& provenance) {
  using Model = TrainedModel<NetworkType, ContextType>;
  using Scalar = typename Model::Scalar;
  if (!is_identifier(struct_name)) throw std::invalid_argument("export: '" + struct_name + "' is not a C++ identifier");
  const auto golden_commands = detail::golden_commands(model, golden);

  const std::string scalar = type_name<Scalar>();
  const auto array = [&](const std::string& type, const char* name, const auto& values) {
    out << "  static constexpr std::array<" << type << ", " << values.size() << "> " << name << " = {";
    detail::write_braced(out, values, "  ");
    out << "};\n";
  };
  const auto text = [&](const char* name, const std::string& value) {
    out << "  static constexpr const char* " << name << " = " << detail::quoted(value) << ";\n";
  };
  const auto scaler = [&](const char* name, const auto& value) {
    out << "  static constexpr pinnquad::Scaler<" << scalar << ", " << value.mean.size() << "> " << name << " = {{";
    detail::write_braced(out, value.mean, "  ");
    out << "}, {";
    detail::write_braced(out, value.spread, "  ");
    out << "}};\n";
  };
  const auto table = [&](const std::string& type, const char* name, const auto& rows) {
    out << "  static constexpr std::array<std::array<" << type << ", " << rows[0].size() << ">, " << rows.size() << "> "
        << name << " = {{";
    for (std::size_t i = 0; i < rows.size(); ++i) {
      out << (i == 0 ? "\n    {" : ",\n    {");
      detail::write_braced(out, rows[i], "    ");
      out << '}';
    }
    out << "}};\n";
  };

  out << "// Inverse-dynamics model, exported by pinnquad " << PINNQUAD_VERSION
      << ". Generated: export again rather than edit.\n"
      << "// SI units, rad. Commands in the order of the airframe's rotors.\n"
      << "#pragma once\n\n#include \"pinnquad/flight.hpp\"\n\n"
      << "struct " << struct_name << " {\n"
      << "  using Scalar = " << scalar << ";\n"
      << "  using Network = " << type_name<NetworkType>() << ";\n"
      << "  using Features = " << type_name<typename Model::Features>() << ";\n"
      << "  using Outputs = " << type_name<typename Model::Outputs>() << ";\n"
      << "  using Vehicle = " << type_name<typename Model::Vehicle>() << ";\n"
      << "  using Inputs = Features::Inputs<Scalar>;\n\n"
      << "  static constexpr int format_version = " << model_format_version << ";\n";
  text("name", struct_name);
  out << "\n  // provenance\n";
  text("training_data", provenance.training_data);
  out << "  static constexpr std::uint64_t training_data_hash = " << detail::hexadecimal(provenance.training_data_hash)
      << ";\n"
      << "  static constexpr int training_rows = " << provenance.training_rows << ";\n"
      << "  static constexpr std::uint64_t seed = " << provenance.seed << "u;\n"
      << "  static constexpr int epochs = " << provenance.epochs << ";\n";
  text("loss", provenance.loss);
  out << "\n  // what it was trained for; require_model() compares with Features, Outputs and Vehicle\n";
  text("frame", model_frame);
  array("const char*", "feature_names", Model::Features::names);
  array("const char*", "feature_units", Model::Features::units);
  array("const char*", "output_names", Model::Outputs::names);
  text("output_unit", Model::Outputs::unit);
  text("vehicle_name", Model::Vehicle::name);
  out << "  // rotor by rotor: signs of its torque about x, y, z\n";
  table("int", "motor_torque_signs", motor_torque_signs<typename Model::Vehicle>());
  out << "\n  // standardisation: (value - mean) / spread\n";
  scaler("input", model.input);
  scaler("output", model.output);
  out << "\n  // training envelope per feature, margin included\n";
  array(scalar, "envelope_lower", model.envelope_lower);
  array(scalar, "envelope_upper", model.envelope_upper);

  out << "\n  // golden vectors: features in physical units -> commands\n";
  table(scalar, "golden_features", golden);
  table(scalar, "golden_commands", golden_commands);

  out << "\n  // layer by layer: weights row-major (row = output, column = input), then biases\n";
  array(scalar, "parameters", model.network.parameters);
  out << "};\n\nstatic_assert(pinnquad::require_model<" << struct_name << ">());\n";
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
