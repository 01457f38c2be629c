// SPDX-License-Identifier: MIT
// Networks in ONNX (https://onnx.ai), read and written by Debian's libonnx. Where the program was built without it,
// each function throws std::invalid_argument, one line that says what to install.
#pragma once

#include <functional>
#include <string>

#include "convert/exported_network.hpp"
#include "convert/foreign_network.hpp"

namespace programs {

/// The bytes of a file beside the model, where a tensor has its numbers in one ("external data"): by the location that
/// the model says, and the tensor's name for messages. Throws InputError.
using FileBeside = std::function<std::string(const std::string& location, const std::string& tensor)>;

/// The network of a model's bytes: a chain from one input [rows, features] to one output, of the operators that
/// docs/convert.md lists. Throws InputError, one line that names the node: an operator that is none of these, shapes
/// that are not known or do not fit, another type of numbers, numbers that are none.
ForeignNetwork read_onnx(const std::string& bytes, const std::string& path, const FileBeside& beside);

/// The bytes of a model: features in physical units, [rows, features], to commands, [rows, 4]. `path` is for messages.
std::string onnx_bytes(const ExportedNetwork& network, const std::string& path);

}  // namespace programs
