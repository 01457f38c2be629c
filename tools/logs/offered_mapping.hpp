// SPDX-License-Identifier: MIT
// The ready mapping that a log's content asks for: nobody has to name it then.
#pragma once

#include <optional>
#include <string>

namespace pinnquad::logs {

struct OfferedMapping {
  std::string name;  ///< "betaflight"
  std::string why;   ///< "a blackbox log of Betaflight 4.4.2"
};

/// By the file's first bytes: PX4's topics in a ULog file, the firmware in a blackbox log's head, DataFlash, a
/// Crazyflie's uSD log; of a table by its columns, where one ready mapping alone finds all that it needs; of a folder
/// what its logs ask for. Empty where nothing tells. Throws InputError for what cannot be read.
std::optional<OfferedMapping> offered_mapping(const std::string& path);

}  // namespace pinnquad::logs
