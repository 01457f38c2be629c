// SPDX-License-Identifier: MIT
// Writes a trained or an exported model as a block of bytes, to be read in place by a ModelView: weights that change
// without a new firmware. Layout: inference/model_block.hpp; the same bytes on every machine.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
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
  /// With its closing 0.
  void add_text(std::string_view text) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
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

/// The records of a block: their counts, then each.
template <class Shape>
std::vector<unsigned char> block_records(const ExportedTerms& terms) {
  using Scalar = typename Shape::Scalar;
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  constexpr std::size_t longest = std::numeric_limits<std::uint16_t>::max();
  LittleEndianBytes out;
  std::uint32_t count = 0;
  const auto record = [&](BlockRecord type, bool mandatory, const auto& fill) {
    LittleEndianBytes bytes;
    fill(bytes);
    if (bytes.bytes.size() > longest) throw std::invalid_argument("export: a record of a model block is too long");
    out.add_unsigned(static_cast<std::uint16_t>(static_cast<unsigned>(type) | (mandatory ? mandatory_record : 0u)));
    out.add_unsigned(std::uint16_t{0});
    out.add_unsigned(static_cast<std::uint32_t>(bytes.bytes.size()));
    bytes.bytes.resize(BlockRecordLayout::padded(bytes.bytes.size()), 0);
    out.bytes.insert(out.bytes.end(), bytes.bytes.begin(), bytes.bytes.end());
    ++count;
  };
  const auto scalars = [](LittleEndianBytes& to, const std::vector<double>& values) {
    for (const double value : values) to.add(static_cast<Scalar>(value));
  };
  record(BlockRecord::commands, true, [&](LittleEndianBytes& to) {
    to.add_unsigned(static_cast<std::uint32_t>(terms.command_meaning));
    to.add_unsigned(std::uint32_t{0});
    scalars(to, {terms.command_lower, terms.command_upper});
  });
  record(BlockRecord::clock, true, [&](LittleEndianBytes& to) {
    to.add_unsigned(nanoseconds(terms.sample_period_s));
    to.add_unsigned(nanoseconds(terms.lag_removed_s));
  });
  record(BlockRecord::window, true, [&](LittleEndianBytes& to) {
    to.add_unsigned(static_cast<std::uint32_t>(WindowOf<Features>::taps));
    to.add_unsigned(static_cast<std::uint32_t>(WindowOf<Features>::causal));
  });
  const auto& names = extra_column_names<Features>;
  if (names.size() > 0) {
    record(BlockRecord::columns, true, [&](LittleEndianBytes& to) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        to.add_text(names[i]);
        to.add_text(extra_column_units<Features>[i]);
      }
    });
  }
  record(BlockRecord::allocation, true, [&](LittleEndianBytes& to) {
    for (const auto& row : terms.allocation) scalars(to, {row.begin(), row.end()});
  });
  const std::string base = description_text<typename BaseOf<Outputs>::type>();
  if (!base.empty()) {
    record(BlockRecord::base, true,
           [&](LittleEndianBytes& to) { to.bytes.insert(to.bytes.end(), base.begin(), base.end()); });
  }
  if (terms.judged) {
    record(BlockRecord::verdict, false, [&](LittleEndianBytes& to) {
      to.add_unsigned(*terms.judged);
      to.add_unsigned(std::uint32_t{0});
    });
  }
  if (terms.slope_signs) {
    record(BlockRecord::slope_signs, false, [&](LittleEndianBytes& to) {
      for (const TorqueSigns& rotor : *terms.slope_signs) {
        for (const int sign : rotor) to.bytes.push_back(static_cast<unsigned char>(sign));
      }
    });
  }
  if (terms.residual_range) {
    record(BlockRecord::residual_range, false, [&](LittleEndianBytes& to) {
      scalars(to, terms.residual_range->lower);
      scalars(to, terms.residual_range->upper);
    });
  }
  if (terms.distance) {
    record(BlockRecord::distance, false, [&](LittleEndianBytes& to) {
      scalars(to, terms.distance->mean);
      scalars(to, terms.distance->inverse_cholesky);
      scalars(to, {terms.distance->limit});
    });
  }
  LittleEndianBytes all;
  all.add_unsigned(count);
  all.add_unsigned(static_cast<std::uint32_t>(out.bytes.size()));
  all.bytes.insert(all.bytes.end(), out.bytes.begin(), out.bytes.end());
  return std::move(all.bytes);
}

/// `model` has scalers and envelope, as an object or as static members.
template <class Shape, class Model, class GoldenFeatures, class GoldenCommands, class Parameters>
std::vector<unsigned char> block_of(const Model& model, const GoldenFeatures& golden_features,
                                    const GoldenCommands& golden_commands, const Parameters& parameters,
                                    const std::vector<unsigned char>& records, std::uint64_t shape,
                                    std::uint64_t training_data_hash, std::uint64_t training_rows) {
  using Layout = ModelBlockLayout<Shape>;
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  const std::uint64_t golden = golden_features.size();
  const std::uint64_t length = Layout::length(golden) + records.size();
  if (golden > most || training_rows > most || length > most) {
    throw std::invalid_argument("export: a model block counts to 2^32 - 1");
  }
  LittleEndianBytes out;
  for (const unsigned char byte : model_block_magic) out.bytes.push_back(byte);
  out.add_unsigned(model_block_version);
  for (const std::uint64_t count :
       {length, std::uint64_t{sizeof(typename Shape::Scalar)}, std::uint64_t{Layout::inputs},
        std::uint64_t{Layout::outputs}, std::uint64_t{Layout::parameter_count}, golden, training_rows}) {
    out.add_unsigned(static_cast<std::uint32_t>(count));
  }
  out.add_unsigned(shape);
  out.add_unsigned(training_data_hash);
  out.bytes.insert(out.bytes.end(), records.begin(), records.end());
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
  const auto records =
      detail::block_records<Model>(detail::exported_terms<typename Model::Features, typename Model::Outputs>(
          provenance, model.template airframe<double>()));
  const std::uint64_t shape = detail::hash_of_shape<Model>(printable(model.airframe_name()),
                                                           motor_torque_signs(model.template airframe<double>()));
  return detail::block_of<Model>(model, golden, golden_commands, model.network.parameters, records, shape,
                                 provenance.training_data_hash, provenance.training_rows);
}

/// The block of an exported header, of format 2 or later: the bytes that its training would have written as a block.
template <class Model>
std::vector<unsigned char> model_block() {
  static_assert(require_model<Model>());
  static_assert(Model::format_version >= 2,
                "pinnquad: a header of format 1 does not check its own names; export it again");
  return detail::block_of<Model>(Model{}, Model::golden_features, Model::golden_commands, Model::parameters,
                                 detail::block_records<Model>(detail::header_records<Model>()), shape_hash<Model>,
                                 Model::training_data_hash, static_cast<std::uint64_t>(Model::training_rows));
}

/// A block as a file that appears whole or not at all.
inline void write_weight_file(const std::string& path, const std::vector<unsigned char>& block) {
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
  file.commit();
}

}  // namespace pinnquad
