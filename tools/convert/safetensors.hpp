// SPDX-License-Identifier: MIT
// Files of tensors by name: eight bytes of length, a JSON header, raw bytes
// (https://github.com/huggingface/safetensors). Read as torch.nn.Sequential's state_dict names them, and written so.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "convert/features_file.hpp"
#include "convert/foreign_network.hpp"

namespace programs {

struct Tensor {
  std::vector<std::size_t> shape;
  Numbers values;  ///< row-major
};
using Tensors = std::map<std::string, Tensor>;

/// The tensors of the bytes of a file, those of whole numbers left out. Throws InputError, one line: cut short, no JSON
/// or another one than the format's, offsets that overlap, leave holes or lead out of the file, a name twice, numbers
/// of another type than F64, F32, F16, BF16 and, left out, I64, and NaN or Inf.
Tensors read_safetensors(const std::string& bytes, const std::string& path);

/// The chain of a state_dict: Linear and BatchNorm1d by their numbers, what has no numbers by the features file. Throws
/// InputError, one line: a module that is none of these, shapes that do not fit, activations too many or too few.
ForeignNetwork safetensors_network(const Tensors& tensors, const std::string& path, const ForeignMeaning& meaning);

/// The bytes of a file of F32 or F64.
std::string safetensors_bytes(const std::vector<std::pair<std::string, Tensor>>& tensors, bool is_double,
                              const std::map<std::string, std::string>& metadata);

}  // namespace programs
