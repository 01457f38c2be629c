// SPDX-License-Identifier: MIT
// What goes wrong with a file, as one line that a program can print as it is before it exits with code 2.
// Reading gives InputError, writing gives OutputError.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <system_error>

#include "pinnquad/io/printable.hpp"

namespace pinnquad {

/// A file that cannot be read as what it should be. what() is one line: `path:line:column: expected ..., found ...`.
/// Line and column count from 1, a column is a field of a row; 0 means that there is none, and it is not printed.
/// The path is shown by printable().
struct InputError : std::runtime_error {
  InputError(const std::string& path_, std::size_t line_, std::size_t column_, const std::string& expected,
             const std::string& found)
      : std::runtime_error(printable(path_) + (line_ > 0 ? ":" + std::to_string(line_) : "") +
                           (line_ > 0 && column_ > 0 ? ":" + std::to_string(column_) : "") + ": expected " + expected +
                           ", found " + found),
        path(path_),
        line(line_),
        column(column_) {}

  std::string path;
  std::size_t line;
  std::size_t column;
};

/// A file that cannot be written. what() is one line: `cannot write path: reason`.
struct OutputError : std::runtime_error {
  OutputError(const std::string& path_, const std::string& reason)
      : std::runtime_error("cannot write " + printable(path_) + ": " + reason), path(path_) {}

  std::string path;
};

/// The system's words for an errno value, or `otherwise` when it is 0.
inline std::string system_reason(int error_number, const char* otherwise) {
  return error_number != 0 ? std::generic_category().message(error_number) : std::string(otherwise);
}

}  // namespace pinnquad
