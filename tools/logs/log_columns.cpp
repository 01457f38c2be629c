// SPDX-License-Identifier: MIT
#include "logs/log_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "logs/bound_log.hpp"
#include "logs/nearest_names.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {
namespace {

/// "deg" of "roll (deg)" where `name` is "roll"; empty for another column.
std::string unit_behind(const std::string& column, const std::string& name) {
  if (column.size() < name.size() + 3 || column.compare(0, name.size(), name) != 0) return "";
  std::size_t begin = name.size();
  while (begin < column.size() && column[begin] == ' ') ++begin;
  const bool round = column[begin] == '(' && column.back() == ')',
             square = column[begin] == '[' && column.back() == ']';
  if (!(round || square) || column.find_first_of("()[]", begin + 1) != column.size() - 1) return "";
  const std::string unit = column.substr(begin + 1, column.size() - begin - 2);
  const bool index = unit.find_first_not_of("0123456789") == std::string::npos;  // "gyro[0]" is no gyro in "0"
  return index ? "" : unit;
}

Dimension dimension_of(const Source& source) {
  if (source.quantity == Quantity::motors) return Dimension::rotor_speed;
  if (source.quantity == Quantity::attitude && !source.euler) return Dimension::none;
  return source.quantity == Quantity::extra ? Dimension::none : facts_of(source.quantity).dimension;
}

/// The column of lists among whose numbers "p[0]" would be; null where there is none.
const LogText* lists_of(const LogTopic& topic, const std::string& name) {
  for (std::size_t at = name.rfind('['); at != std::string::npos && at > 0; at = name.rfind('[', at - 1)) {
    if (const LogText* text = topic.text(name.substr(0, at))) return text;
  }
  return nullptr;
}

}  // namespace

const LogColumn* column_named(const LogTopic& topic, const std::string& name) {
  if (const LogColumn* column = topic.column(name)) return column;
  const LogColumn* found = nullptr;
  for (const LogColumn& column : topic.columns) {
    if (unit_behind(column.name, name).empty()) continue;
    if (found != nullptr) return nullptr;
    found = &column;
  }
  return found;
}

std::vector<const LogColumn*> columns_in(const LogTopic& topic, const std::vector<NamedColumn>& wanted,
                                         const std::string& mapping_file, bool why) {
  std::vector<const LogColumn*> found;
  for (const NamedColumn& one : wanted) {
    if (const LogColumn* column = column_named(topic, one.name)) {
      found.push_back(column);
      continue;
    }
    const LogText* const lists = lists_of(topic, one.name);
    if (lists != nullptr && (why || lists->first_text > 0)) {
      throw wrong_cell(topic, lists->first_text, lists->name, "lists of one length in column " + lists->name,
                       quoted_cell(lists->values[lists->first_text]));
    }
    if (!why) return {};
    if (const LogText* text = topic.text(one.name)) {
      throw wrong_cell(topic, text->first_text, one.name, "a number in column " + one.name,
                       quoted_cell(text->values[text->first_text]));
    }
    const std::string where = topic_words(topic.name, topic.instance) + " in " + topic.file;
    if (topic.columns.empty() && topic.texts.empty()) {
      throw InputError(mapping_file, one.place.line, one.place.column, "`" + printable(one.name) + "` in " + where,
                       "no variable at all: " + std::to_string(topic.size()) +
                           " rows of times alone (a comment or a wrong name in the logger's list of variables, a "
                           "Crazyflie's config.txt?)");
    }
    if (topic.columns.empty()) {
      throw InputError(mapping_file, one.place.line, one.place.column, "`" + printable(one.name) + "` in " + where,
                       "no column of numbers at all: rows of keys and texts, such as Blackbox Explorer's before its "
                       "table, which is missing");
    }
    std::vector<std::string> known;
    for (const LogColumn& column : topic.columns) known.push_back(column.name);
    throw InputError(mapping_file, one.place.line, one.place.column, "a column of " + where,
                     "`" + printable(one.name) + "`, which it has not; " + nearest_names(one.name, known));
  }
  return found;
}

std::optional<double> own_unit(const LogColumn& column, const std::string& wanted, Dimension dimension,
                               bool mapping_says_unit) {
  if (column.name != wanted) return unit_in_si(dimension, unit_behind(column.name, wanted));
  if (mapping_says_unit || column.unit.empty()) return std::nullopt;
  return unit_in_si(dimension, column.unit);
}

std::optional<double> number_in(const FlightLog& log, const MappedNumber& number) {
  if (number.parameter.empty()) return number.value;
  const double logged = log.parameter(number.parameter, std::nan("")), value = number.divides ? 1 / logged : logged;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::vector<double>> scaled_values(const FlightLog& log, const Mapping& mapping, const Source& source,
                                               const std::vector<const LogColumn*>& columns, bool why) {
  const std::optional<double> scale = number_in(log, source.scale);
  const bool says = !source.unit.empty() || !source.scale.parameter.empty() || !(scale && std::abs(*scale - 1) < 1e-12);
  std::vector<std::vector<double>> values;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& wanted = source.columns[i].name;
    std::optional<double> factor = own_unit(*columns[i], wanted, dimension_of(source), says);
    if (source.quantity == Quantity::extra && unit_behind(columns[i]->name, wanted) == source.unit) factor = 1;
    values.push_back(columns[i]->values);
    if (factor) {
      for (double& value : values.back()) value *= *factor;
      continue;
    }
    if (!scale) {
      if (!why) return {};
      throw InputError(mapping.file, source.place.line, source.place.column,
                       "the parameter " + source.scale.parameter + " in " + log.source + ", which the scale needs",
                       "none");
    }
    const bool plain = !(std::abs(*scale - 1) > 0) && !(std::abs(source.offset) > 0);
    for (double& value : values.back()) value = (plain ? value : value * *scale + source.offset) * source.in_si;
  }
  return values;
}

}  // namespace pinnquad::logs
