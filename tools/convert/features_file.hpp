// SPDX-License-Identifier: MIT
// The meaning of a foreign network's numbers, which no ONNX or safetensors file says: features.toml (docs/convert.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "convert/foreign_network.hpp"
#include "logs/airframe_file.hpp"
#include "pinnquad/dynamics/actuator.hpp"

namespace programs {

/// An activation of the library as a features file names it: "leaky_relu" of "pinnquad::LeakyRelu".
std::string activation_word(std::string_view layer);
/// The layer that is called so; empty: none.
std::string activation_layer(const std::string& word);
/// The same of layer_norm, rms_norm and glu, which no features file names.
std::string counted_layer(const std::string& word);

/// A number that the network reads: (value in that unit - mean) / scale.
struct ForeignFeature {
  std::string name;
  std::string unit;     ///< the library's
  double unit_factor;   ///< the file's numbers are the library's times this
  double lower, upper;  ///< of the envelope; in the file's unit, as mean and scale are
  double mean, scale;
  bool is_standardised;  ///< the file says mean or scale
  bool is_column;        ///< none of the library's: a measured column
};

/// All that a features file says.
struct ForeignMeaning {
  std::string path;
  std::vector<ForeignFeature> features;  ///< in the network's order
  std::vector<std::string> outputs;      ///< in the network's order, by the schema's names
  Numbers output_mean, output_scale;     ///< output = network's * scale + mean
  std::string schema;                    ///< description of the output schema
  std::vector<std::string> activations;  ///< of tensors by name, which say none; in order
  bool one_activation = false;           ///< a text in place of a list: that one everywhere between
  std::vector<std::string> layers;       ///< of tensors by name, whose names say no order
  std::optional<pinnquad::CommandMeaning> command_meaning;
  double sample_period_s = 0;
  pinnquad::logs::NamedAirframe airframe;
};

/// Throws InputError, one line with line and column, for a file that can't be read, is no TOML, has a key that is
/// unknown, missing or of another kind, and for values that no network has.
ForeignMeaning read_features_file(const std::string& path);

/// The same of a text; `path` names it.
ForeignMeaning parse_features(const std::string& text, const std::string& path);

}  // namespace programs
