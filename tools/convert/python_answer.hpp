// SPDX-License-Identifier: MIT
// Answers of networks.py (tools/python/pinnquad), which the program carries along and runs by python3.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "convert/foreign_network.hpp"

namespace programs {

/// The answer to a request. Throws InputError, one line, where it says what is wrong with the source at `path`.
nlohmann::json python_answer(const AskPython& ask, const std::string& request, const std::string& path);

/// Runs networks.py by $PINNQUAD_PYTHON, else by the first python3 of PATH that has its packages. Throws
/// std::invalid_argument, one line, where none answers, and Interrupted.
std::string run_python(const std::string& request);

}  // namespace programs
