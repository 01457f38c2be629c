// SPDX-License-Identifier: MIT
// The file of a network, and a file beside it that has its numbers: what an ONNX model names leads to no other folder.
#pragma once

#include <string>

namespace programs {

/// Throws InputError, one line: no such file, no regular one, more than 64 MiB.
std::string network_bytes(const std::string& path);

/// The bytes of the file `location`, by the folder of the model at `path`; `tensor` is for messages. Throws InputError,
/// one line: an absolute location, one with "..", a link that leads out of the folder, and as network_bytes().
std::string bytes_beside(const std::string& path, const std::string& location, const std::string& tensor);

}  // namespace programs
