// SPDX-License-Identifier: MIT
// Writes answers of networks.py and features files, into a folder, for the fuzzer to begin with:
// convert_seeds DIR
#include <string>

#include "fuzz/seeds.hpp"

int main(int argument_count, char** arguments) {
  return pinnquad_test::write_seeds(
      argument_count, arguments,
      {
          R"(N{"inputs": 2, "outputs": 4, "answers": [[0.5, 0.5, 0.5, 0.5]], "layers": [
        {"weights": [[0.5, -0.25], [1, 2], [-0.125, 0.75]], "bias": [0, 0.5, -1]}, "leaky_relu",
        {"weights": [[1, 0, 0.5], [0, 1, 0.25], [0.5, 0.5, 0], [-1, 0, 1]], "bias": [0.5, 0.5, 0.5, 0.5]}]})",
          R"(N{"inputs": 1, "outputs": 4, "answers": [],
        "layers": [{"weights": [[1], [2], [3], [4]], "bias": [0, 0, 0, 0]}]})",
          R"(N{"expected": "an ONNX model", "found": "none", "path": null})",
          "N",
          "Ffeature = [{ name = \"s_z\", unit = \"g\", lower = -3, upper = 1, mean = -1, scale = 0.5 },\n"
          "{ name = \"volts\", unit = \"V\", lower = 13, upper = 17 }]\nactivations = [\"tanh\", \"identity\"]\nlayers "
          "= "
          "[\"fc1\"]\n"
          "commands_are = \"throttle\"\nsample_period_s = 0.02\n[output]\nnames = [\"u2\", \"u1\", \"u4\", \"u3\"]\n"
          "mean = [0, 0, 0, 0]\nscale = [1, 1, 1, 1]\n[airframe]\nname = \"px4_sih\"\n",
      });
}
