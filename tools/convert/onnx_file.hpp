// SPDX-License-Identifier: MIT
// Networks in ONNX (https://onnx.ai), read and written by Debian's libonnx. Where the program was built without it,
// each function throws std::invalid_argument, one line that says what to install.
#pragma once

#include <map>
#include <string>

#include "convert/exported_network.hpp"
#include "convert/foreign_network.hpp"

namespace programs {

/// The network of a model's bytes: a chain from one input [rows, features] to one output, of Gemm, MatMul, Add, Sub,
/// Mul, Div, BatchNormalization, Relu, Tanh, Sigmoid, Softplus, Sin, Gelu, Identity, Flatten, Dropout, Cast, Constant,
/// Transpose of a constant, and of Erf and Mul as they make GELU and SiLU. Throws InputError, one line that names the
/// node: an operator that is none of these, shapes that are not known or do not fit, another type of numbers, data in
/// another file, numbers that are none.
ForeignNetwork read_onnx(const std::string& bytes, const std::string& path);

/// The bytes of a model: features in physical units, [rows, features], to commands, [rows, 4]. `path` is for messages.
std::string onnx_bytes(const ExportedNetwork& network, const std::string& path);

}  // namespace programs
