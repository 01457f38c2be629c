// SPDX-License-Identifier: MIT
// What may be read: a regular file of a size that a program can take in.
// A pipe or a device may never end, so that reading one would be waiting for ever.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

namespace detail {

/// Most bytes of a file that is read: the longest flight that `fly` records has 4e9.
inline constexpr std::uintmax_t most_input_bytes = std::uintmax_t{1} << 33;

[[noreturn]] inline void refuse_size(const std::string& path) {
  throw InputError(path, 0, 0, "a file of at most " + std::to_string(most_input_bytes >> 30) + " GiB", "a larger one");
}

}  // namespace detail

/// Throws InputError, one line, for all that is there and is not such a file. What is absent passes: who opens it has
/// the system's reason.
inline void require_regular_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) throw InputError(path, 0, 0, "a readable file", "a folder");
  if (!fs::is_regular_file(status)) throw InputError(path, 0, 0, "a regular file", "a device or a pipe");
  const std::uintmax_t bytes = fs::file_size(path, ignored);
  if (!ignored && bytes > detail::most_input_bytes) detail::refuse_size(path);
}

}  // namespace pinnquad
