// SPDX-License-Identifier: MIT
// Folders that outputs go into.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "pinnquad/io/file_error.hpp"

namespace programs {

/// Makes the folder and those above it, where they are not there. Throws OutputError: one of them cannot be.
inline void make_folders(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw pinnquad::OutputError(path, error.message());
}

}  // namespace programs
