// SPDX-License-Identifier: MIT
// Writes a trained or an exported model as a block of bytes, to be read in place by a ModelView: weights that change
// without a new firmware. Layout: inference/model_block.hpp; the same bytes on every machine.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/atomic_file.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/inference/model_block.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

namespace detail {

/// Bytes appended, least significant first.
class LittleEndianBytes {
 public:
  template <class Unsigned>
  void add_unsigned(Unsigned value) {
    for (std::size_t byte = 0; byte < sizeof value; ++byte) {
      bytes.push_back(static_cast<unsigned char>((value >> (8 * byte)) & 0xffu));
    }
  }
  void add(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add_unsigned(bits);
  }
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add_unsigned(bits);
  }
  template <class Scalar, std::size_t Size>
  void add(const std::array<Scalar, Size>& values) {
    for (const Scalar value : values) add(value);
  }
  template <class Rows>
  void add_rows(const Rows& rows) {
    for (const auto& row : rows) add(row);
  }

  std::vector<unsigned char> bytes;
};

/// `model` has scalers and envelope, as an object or as static members.
template <class Shape, class Model, class GoldenFeatures, class GoldenCommands, class Parameters>
std::vector<unsigned char> block_of(const Model& model, const GoldenFeatures& golden_features,
                                    const GoldenCommands& golden_commands, const Parameters& parameters,
                                    std::uint64_t training_data_hash, std::uint64_t training_rows) {
  using Layout = ModelBlockLayout<Shape>;
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  const std::uint64_t golden = golden_features.size();
  if (golden > most || training_rows > most || Layout::length(golden) > most) {
    throw std::invalid_argument("export: a model block counts to 2^32 - 1");
  }
  LittleEndianBytes out;
  for (const unsigned char byte : model_block_magic) out.bytes.push_back(byte);
  out.add_unsigned(model_block_version);
  for (const std::uint64_t count :
       {Layout::length(golden), std::uint64_t{sizeof(typename Shape::Scalar)}, std::uint64_t{Layout::inputs},
        std::uint64_t{Layout::outputs}, std::uint64_t{Layout::parameter_count}, golden, training_rows}) {
    out.add_unsigned(static_cast<std::uint32_t>(count));
  }
  out.add_unsigned(shape_hash<Shape>);
  out.add_unsigned(training_data_hash);
  out.add(model.input.mean);
  out.add(model.input.spread);
  out.add(model.output.mean);
  out.add(model.output.spread);
  out.add(model.envelope_lower);
  out.add(model.envelope_upper);
  out.add_rows(golden_features);
  out.add_rows(golden_commands);
  out.add(parameters);
  out.add_unsigned(crc32(out.bytes.data(), out.bytes.size()));
  return std::move(out.bytes);
}

}  // namespace detail

/// The block of a trained model. `golden` as for write_model(): feature vectors inside the envelope, at least one.
/// Throws std::invalid_argument where write_model() does.
template <class NetworkType, class ContextType>
std::vector<unsigned char> model_block(
    const TrainedModel<NetworkType, ContextType>& model,
    const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
    const Provenance& provenance) {
  using Model = TrainedModel<NetworkType, ContextType>;
  const auto golden_commands = detail::golden_commands(model, golden);
  return detail::block_of<Model>(model, golden, golden_commands, model.network.parameters,
                                 provenance.training_data_hash, provenance.training_rows);
}

/// The block of an exported header, of format 2: the bytes that its training would have written as a block.
template <class Model>
std::vector<unsigned char> model_block() {
  static_assert(require_model<Model>());
  static_assert(Model::format_version >= 2,
                "pinnquad: a header of format 1 does not check its own names; export it again");
  return detail::block_of<Model>(Model{}, Model::golden_features, Model::golden_commands, Model::parameters,
                                 Model::training_data_hash, static_cast<std::uint64_t>(Model::training_rows));
}

/// A block as a file that appears whole or not at all.
inline void write_weight_file(const std::string& path, const std::vector<unsigned char>& block) {
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
  file.commit();
}

}  // namespace pinnquad
