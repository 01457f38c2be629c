// SPDX-License-Identifier: MIT
// The columns and numbers of a log that a mapping names: found with and without the unit that a log writes behind a
// name, and turned into SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "logs/mapping.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

/// The column of that name, or else the only one that is the name and a unit behind it: "roll" finds "roll (deg)". Null
/// if there is none.
const LogColumn* column_named(const LogTopic& topic, const std::string& name);

/// The columns of a topic that a source names. With `why` the reason is thrown where one is missing or holds text, else
/// the result is empty.
std::vector<const LogColumn*> columns_in(const LogTopic& topic, const std::vector<NamedColumn>& wanted,
                                         const std::string& mapping_file, bool why);

/// The factor to SI of the unit that the log says itself: behind the name, where the mapping left it out, or in a row
/// of units, where the mapping says none. Empty: the mapping decides.
std::optional<double> own_unit(const LogColumn& column, const std::string& wanted, Dimension dimension,
                               bool mapping_says_unit);

/// A number of the mapping, or the log's parameter that it names; empty where the log has no such parameter.
std::optional<double> number_in(const FlightLog& log, const MappedNumber& number);

/// The values of a source's columns: (n * scale + offset) * in_si, or by the log's own unit. Empty without the log's
/// parameter that the scale names, of which `why` throws.
std::vector<std::vector<double>> scaled_values(const FlightLog& log, const Mapping& mapping, const Source& source,
                                               const std::vector<const LogColumn*>& columns, bool why);

}  // namespace pinnquad::logs
