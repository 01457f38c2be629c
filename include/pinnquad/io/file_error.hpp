// SPDX-License-Identifier: MIT
// Errors of files, one line that a program prints before it exits with code 2: reading throws InputError, writing
// OutputError. And text from outside (a file's name) made fit for a message, a report or a generated file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace pinnquad {

namespace detail {

/// Control characters, line and paragraph separators, marks that turn the direction of writing.
bool steers(std::uint32_t code_point);

}  // namespace detail

/// `text` with every byte that is no UTF-8 and every control character, line break and mark of direction as '?'.
std::string printable(std::string_view text);

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
std::string system_reason(int error_number, const char* otherwise);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/core/body.hpp"
#include "pinnquad/io/impl/file_error.hpp"
#endif
