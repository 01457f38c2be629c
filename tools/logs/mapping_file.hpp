// SPDX-License-Identifier: MIT
// A mapping from TOML: its tables are the quantities, and what is wrong is said with line and column.
#pragma once

#include <string>

#include "logs/mapping.hpp"

namespace programs {

/// Throws InputError, one line: no TOML, keys that are none, values of another kind.
Mapping read_mapping_file(const std::string& path);
/// The same of text; `path` is for messages.
Mapping parse_mapping(const std::string& text, const std::string& path);

}  // namespace programs
