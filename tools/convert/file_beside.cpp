// SPDX-License-Identifier: MIT
#include "convert/file_beside.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

namespace fs = std::filesystem;
using pinnquad::InputError;
using pinnquad::printable;

std::string network_bytes(const std::string& path) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 26;
  std::error_code absent;
  const std::uintmax_t size = fs::file_size(path, absent);
  if (!absent && size > most_bytes) {
    throw InputError(path, 0, 0, "a network of at most 64 MiB", std::to_string(size) + " bytes");
  }
  return pinnquad::file_text(path);
}

std::string bytes_beside(const std::string& path, const std::string& location, const std::string& tensor) {
  const fs::path said = location, folder = fs::path(path).parent_path();
  const std::string found = "'" + printable(location) + "'";
  const bool leads_up = std::find(said.begin(), said.end(), "..") != said.end();
  if (location.empty() || location.find('\0') != std::string::npos || said.is_absolute() || leads_up) {
    throw InputError(path, 0, 0, tensor + ": the location of its external data, a file in the model's folder", found);
  }
  std::error_code error;
  const fs::path file = folder / said;
  if (!fs::exists(file, error)) {
    throw InputError(path, 0, 0,
                     tensor + ": its data in " + printable(file.string()) +
                         " (torch.onnx.export(..., external_data=False) writes one file alone)",
                     "no such file");
  }
  const fs::path own = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path inside = error ? fs::path() : fs::canonical(file, error).lexically_relative(own);
  if (error || inside.empty() || *inside.begin() == "..") {
    throw InputError(path, 0, 0, tensor + ": its data in the model's folder", found + ", a link that leads out of it");
  }
  return network_bytes(file.string());
}

}  // namespace programs
