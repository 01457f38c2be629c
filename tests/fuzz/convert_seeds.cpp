// SPDX-License-Identifier: MIT
// Writes networks of safetensors and ONNX, and features files, into a folder, for the fuzzer to begin with:
// convert_seeds DIR
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace {

/// Written by Python's onnx: Gemm, BatchNormalization, a GELU, a SiLU, MatMul, Relu and Tanh, from 2 features to 4.
constexpr char onnx_model[] =
    // clang-format off
    "\010\007:\347\003\012!\012\001x\012\001w\012\001b\022\001a\042\004Gemm*\015\012\006transB\030\001\240\001"
    "\002\012&\012\001a\012\001g\012\001h\012\001m\012\001v\022\001n\042\022BatchNormalization\012\016\012\001n"
    "\012\001r\022\001d\042\003Div\012\013\012\001d\022\001e\042\003Erf\012\016\012\001e\012\001o\022\001f\042"
    "\003Add\012\016\012\001n\012\001f\022\001i\042\003Mul\012\016\012\001i\012\001q\022\001j\042\003Mul\012\017"
    "\012\001j\022\001k\042\007Sigmoid\012\016\012\001j\012\001k\022\001l\042\003Mul\012\021\012\001l\012\001p"
    "\022\001s\042\006MatMul\012\014\012\001s\022\001t\042\004Relu\012\014\012\001t\022\001u\042\004Tanh\022\001"
    "g*\033\010\002\010\002\020\001\042\020\000\000\000\077\000\000\200>\000\000\000\277\000\000\200\077B\001w*"
    "\021\010\002\020\001\042\010\000\000\000\077\000\000\000\277B\001b*\021\010\002\020\001\042\010\000\000\200"
    "\077\000\000\000@B\001g*\021\010\002\020\001\042\010\000\000\000\000\000\000\200\077B\001h*\021\010\002\020"
    "\001\042\010\000\000\000\000\000\000\000\077B\001m*\021\010\002\020\001\042\010\000\000\200\077\000\000\000"
    "@B\001v*\013\020\001\042\004\363\004\265\077B\001r*\013\020\001\042\004\000\000\200\077B\001o*\013\020\001"
    "\042\004\000\000\000\077B\001q*+\010\002\010\004\020\001\042 \000\000\000\077\000\000\200>\000\000\000\277"
    "\000\000\200\077\000\000\000\077\000\000\200>\000\000\000\277\000\000\200\077B\001pZ\024\012\001x\022\017"
    "\012\015\010\001\022\011\012\003\022\001r\012\002\010\002b\024\012\001u\022\017\012\015\010\001\022\011\012"
    "\003\022\001r\012\002\010\004B\004\012\000\020\015";
// clang-format on

/// Written by it: weights in a file beside, a bias of halves, an ELU and a leaky ReLU of other alphas, a Clip.
constexpr char external_model[] =
    // clang-format off
    "\010\007\022\000:\325\002\012\041\012\001x\012\001w\012\001b\022\001a\042\004Gemm*\015\012\006transB\030\001"
    "\240\001\002\012\034\012\001a\022\001c\042\003Elu*\017\012\005alpha\025\000\000\000\077\240\001\001\012\021"
    "\012\001c\012\001v\022\001d\042\006MatMul\012\042\012\001d\022\001e\042\011LeakyRelu*\017\012\005alpha\025\000"
    "\000\200>\240\001\001\012\022\012\001e\012\001l\012\001u\022\001y\042\004Clip\022\000*5\010\004\010\002\020"
    "\001B\001wj\015\012\010location\022\001wj\013\012\006offset\022\0010j\014\012\006length\022\00232p\001*\020"
    "\010\004\020\012*\007\200p\200\350\002\000\001B\001b*6\010\004\010\004\020\001B\001vj\015\012\010location\022"
    "\001wj\014\012\006offset\022\00232j\014\012\006length\022\00264p\001*\013\020\001\042\004\000\000\000\000B\001"
    "l*\013\020\001\042\004\000\000\200\077B\001uZ\024\012\001x\022\017\012\015\010\001\022\011\012\003\022\001r"
    "\012\002\010\002b\024\012\001y\022\017\012\015\010\001\022\011\012\003\022\001r\012\002\010\004B\004\012\000"
    "\020\015";
// clang-format on

std::string safetensors(const std::string& header, std::size_t numbers) {
  std::string bytes;
  for (std::size_t i = 0; i < 8; ++i) bytes += static_cast<char>(header.size() >> (8 * i) & 0xff);
  bytes += header;
  for (std::size_t i = 0; i < numbers; ++i) {
    const float value = 0.125f * static_cast<float>(i % 9);
    char text[4];
    std::memcpy(text, &value, 4);
    bytes.append(text, 4);
  }
  return bytes;
}

std::string tensor(const std::string& name, const std::string& shape, int begin, int end) {
  return "\"" + name + "\":{\"dtype\":\"F32\",\"shape\":[" + shape + "],\"data_offsets\":[" + std::to_string(begin) +
         "," + std::to_string(end) + "]}";
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  const std::string linear = tensor("0.weight", "4,2", 0, 32) + "," + tensor("0.bias", "4", 32, 48);
  const std::string norm = linear + "," + tensor("1.weight", "4", 48, 64) + "," + tensor("1.bias", "4", 64, 80) + "," +
                           tensor("1.running_mean", "4", 80, 96) + "," + tensor("1.running_var", "4", 96, 112) + "," +
                           tensor("3.weight", "4,4", 112, 176);
  const std::string seeds[] = {
      "S" + safetensors("{" + linear + "}", 12),
      "S" + safetensors("{" + norm + "}  ", 44),
      "S" + safetensors("{}", 0),
      "S",
      "O" + std::string(onnx_model, sizeof onnx_model - 1),
      "O" + std::string(external_model, sizeof external_model - 1),
      "Ffeature = [{ name = \"s_z\", unit = \"g\", lower = -3, upper = 1, mean = -1, scale = 0.5 },\n"
      "{ name = \"volts\", unit = \"V\", lower = 13, upper = 17 }]\nactivations = [\"tanh\", \"identity\"]\n"
      "commands_are = \"throttle\"\nsample_period_s = 0.02\n[output]\nnames = [\"u2\", \"u1\", \"u4\", \"u3\"]\n"
      "mean = [0, 0, 0, 0]\nscale = [1, 1, 1, 1]\n[airframe]\nname = \"px4_sih\"\n",
  };
  bool written = true;
  int number = 0;
  for (const std::string& seed : seeds) {
    std::ofstream out(std::string(arguments[1]) + "/seed" + std::to_string(number++), std::ios::binary);
    written = written && (out << seed).flush().good();
  }
  return written ? 0 : 2;
}
