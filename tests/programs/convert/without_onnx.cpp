// SPDX-License-Identifier: MIT
// A program that was built without libonnx links, and each function says in one line what to install.
#include <cstdio>
#include <stdexcept>
#include <string>

#include "convert/onnx_file.hpp"

namespace {

template <class Call>
bool refused(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    const std::string said = error.what();
    std::puts(error.what());
    return said.rfind("net.onnx: ", 0) == 0 && said.find("libonnx-dev") != std::string::npos &&
           said.find('\n') == std::string::npos;
  }
  return false;
}

}  // namespace

int main() {
  const bool reads = refused([] { programs::read_onnx("", "net.onnx", {}); });
  const bool writes = refused([] { programs::onnx_bytes({}, "net.onnx"); });
  return reads && writes ? 0 : 1;
}
