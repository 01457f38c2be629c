// SPDX-License-Identifier: MIT
// Bodies of trust_writer.hpp.
#pragma once

#include <array>
#include <locale>
#include <sstream>
#include <vector>

#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/deploy/trust_writer.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad {

template <class Scalar>
void write_trust(std::ostream& stream, const std::string& model_name, const FittedTrust& trust,
                 std::uint64_t training_data_hash) {
  detail::require_identifier(model_name);
  const auto rounded = [](const auto& values) {
    std::vector<Scalar> result;
    for (const double value : values) result.push_back(static_cast<Scalar>(value));
    return result;
  };
  const auto mean = rounded(trust.distribution.mean);
  const auto whitening = rounded(trust.distribution.whitening);
  detail::require_finite(mean, "the distribution's mean");
  detail::require_finite(whitening, "the distribution's whitening");
  detail::require_finite(
      std::array<double, 5>{trust.squared_distance_limit, trust.command_residual_factor, trust.command_residual_limit,
                            trust.command_residual_cleared, trust.update_period_s},
      "the trust's limits");
  std::ostringstream out;
  out.imbue(std::locale::classic());
  const std::string scalar = type_name<Scalar>();
  const auto array = [&](const char* name, const auto& values) {
    out << "  static constexpr std::array<" << scalar << ", " << values.size() << "> " << name << " = {";
    detail::write_braced(out, values, "  ");
    out << "};\n";
  };
  const auto number = [&](const char* name, double value) {
    out << "  static constexpr double " << name << " = " << detail::literal(value) << ";\n";
  };
  out << "\n// Limits of trust in the model: JointDistance<" << model_name << "Trust> for its Guard, "
      << "CommandResidualMonitor<" << model_name << "Trust>.\n"
      << "struct " << model_name << "Trust {\n"
      << "  static constexpr std::uint64_t training_data_hash = " << hexadecimal(training_data_hash) << ";\n";
  array("distribution_mean", mean);
  out << "  // lower triangular, column after column\n";
  array("whitening", whitening);
  number("squared_distance_limit", trust.squared_distance_limit);
  out << "  // mean absolute error of the commands, updated every update_period_s\n";
  number("command_residual_factor", trust.command_residual_factor);
  number("command_residual_limit", trust.command_residual_limit);
  number("command_residual_cleared", trust.command_residual_cleared);
  number("update_period_s", trust.update_period_s);
  out << "};\n";
  stream << out.str();
}

#ifdef PINNQUAD_COMPILED
template void write_trust<float>(std::ostream&, const std::string&, const FittedTrust&, std::uint64_t);
template void write_trust<double>(std::ostream&, const std::string&, const FittedTrust&, std::uint64_t);
#endif

}  // namespace pinnquad
