// SPDX-License-Identifier: MIT
// Columns that stand still in a closed loop, as --column NAME=VALUE says them.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "command_line/parse_decimal.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {

/// The value of each column that a model asks for, in their order: where none is given the middle of its envelope.
/// `asked`: columns, each with `name`, `unit`, `lower` and `upper`. Throws std::invalid_argument, one line.
template <class Columns>
std::vector<double> held_columns(const Columns& asked, const std::vector<std::string>& given) {
  using pinnquad::printable;
  std::vector<std::optional<double>> values(asked.size());
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::size_t at = 0;
    while (at < asked.size() && asked[at].name != name) ++at;
    if (at == asked.size()) {
      throw std::invalid_argument(
          "--column: the model asks for no column '" + printable(name) + "'; its columns: " +
          (asked.empty() ? "none" : listed(asked, [](const auto& column) { return printable(column.name); })));
    }
    if (values[at]) throw std::invalid_argument("--column: " + printable(name) + " is given twice");
    constexpr auto most = static_cast<double>(std::numeric_limits<float>::max());
    double value = 0;
    if (equals == std::string::npos || !parse_decimal(text.substr(equals + 1), -most, most, value)) {
      throw std::invalid_argument("--column: expected " + printable(name) + "=NUMBER in " + printable(asked[at].unit) +
                                  ", found '" + printable(text) + "'");
    }
    values[at] = value;
  }
  std::vector<double> held;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    held.push_back(values[i].value_or((asked[i].lower + asked[i].upper) / 2));
  }
  return held;
}

}  // namespace programs
