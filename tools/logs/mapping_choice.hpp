// SPDX-License-Identifier: MIT
// A mapping as a command is given it: by the name of one that the program brings, or by its file.
#pragma once

#include <stdexcept>
#include <string>

#include "command_line/listed.hpp"
#include "command_line/nearest_names.hpp"
#include "logs/mapping_file.hpp"
#include "logs/ready_mappings.hpp"

namespace programs {

inline bool is_mapping_file(const std::string& name) {
  const std::string ending = ".toml";
  return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

/// "arpl, nanobench, px4": for messages and help.
inline std::string mapping_names() {
  return listed(ready_mappings, [](const ReadyMapping& ready) { return std::string(ready.name); });
}

/// The mapping of that name or file. Throws InputError (the file) and std::invalid_argument (no such name), one line.
inline Mapping chosen_mapping(const std::string& name_or_file) {
  if (is_mapping_file(name_or_file)) return read_mapping_file(name_or_file);
  for (const ReadyMapping& ready : ready_mappings) {
    if (name_or_file != ready.name) continue;
    Mapping mapping = parse_mapping(ready.toml, name_or_file + ".toml");
    mapping.name = ready.name;
    return mapping;
  }
  throw std::invalid_argument("no mapping named '" + pinnquad::printable(name_or_file) +
                              "'; known: " + mapping_names() + ", or a file whose name ends in .toml");
}

}  // namespace programs
