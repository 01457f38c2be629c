// SPDX-License-Identifier: MIT
// In place of onnx_file.cpp where libonnx is not installed.
#include <stdexcept>

#include "convert/onnx_file.hpp"

namespace programs {

namespace {

[[noreturn]] void built_without(const std::string& path) {
  throw std::invalid_argument(
      path +
      ": this pinnquad was built without ONNX; as root: apt-get install libonnx-dev libprotobuf-dev, then build "
      "it again");
}

}  // namespace

ForeignNetwork read_onnx(const std::string& /*bytes*/, const std::string& path, const FileBeside& /*beside*/) {
  built_without(path);
}
std::string onnx_bytes(const ExportedNetwork& /*network*/, const std::string& path) { built_without(path); }

}  // namespace programs
