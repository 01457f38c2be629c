// SPDX-License-Identifier: MIT
// The bytes of a model block from what it says, whoever says it: a training, the types of an exported header
// (deploy/weight_file.hpp), or its text. Layout: exported/model_block.hpp; the same bytes on every machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/model_block.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/version.hpp"

namespace pinnquad {
namespace detail {

/// Bytes appended, least significant first. Numbers with a fraction become a Scalar.
template <class Scalar>
class LittleEndianBytes {
 public:
  /// A number, a text without its end, or a range of them or of ranges.
  template <class Value>
  void add(const Value& value) {
    if constexpr (std::is_integral_v<Value>) {
      for (std::size_t byte = 0; byte < sizeof value; ++byte) {
        bytes.push_back(static_cast<unsigned char>(static_cast<std::uint64_t>(value) >> (8 * byte)));
      }
    } else if constexpr (std::is_floating_point_v<Value>) {
      const auto rounded = static_cast<Scalar>(value);
      std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t> bits = 0;
      std::memcpy(&bits, &rounded, sizeof bits);
      add(bits);
    } else {
      for (const auto& one : value) add(one);
    }
  }
  void append(const std::vector<unsigned char>& more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

  std::vector<unsigned char> bytes;
};

PINNQUAD_BODY std::uint64_t double_bits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Where a model comes from and how it was judged: name and value in turn.
PINNQUAD_BODY std::vector<std::string> provenance_texts(const WrittenRecords& records) {
  std::vector<std::string> texts = {"name",          records.name,
                                    "training_data", records.training_data,
                                    "seed",          std::to_string(records.seed),
                                    "epochs",        std::to_string(records.epochs),
                                    "loss",          records.loss,
                                    "network",       records.network_type,
                                    "features",      records.features_type,
                                    "outputs",       records.outputs_type,
                                    "pinnquad",      PINNQUAD_VERSION};
  const ModelFacts& facts = records.facts;
  if (facts.has_r_squared && facts.linear_regression_r_squared > -no_bound) {
    append_texts(texts, std::array{"test_r_squared", "linear_regression_r_squared"},
                 std::array{number_text(facts.test_r_squared), number_text(facts.linear_regression_r_squared)});
  }
  for (std::string& text : texts) text = printable(text);
  return texts;
}

/// The records of a block: their counts, then each.
template <class Scalar>
std::vector<unsigned char> block_records(const WrittenRecords& records) {
  using Bytes = LittleEndianBytes<Scalar>;
  constexpr std::size_t longest = std::numeric_limits<std::uint16_t>::max();
  constexpr std::uint32_t nothing = 0;
  constexpr bool mandatory = true, optional = false;
  Bytes out;
  std::uint32_t count = 0;
  const auto closed = [](const std::vector<std::string>& texts) {
    Bytes all;
    for (const std::string& text : texts) {
      all.add(text);
      all.add('\0');
    }
    return std::move(all.bytes);
  };
  const auto record = [&](BlockRecord type, bool is_mandatory, const auto&... values) {
    Bytes body;
    (body.add(values), ...);
    if (body.bytes.size() > longest) throw std::invalid_argument("export: a record of a model block is too long");
    out.add(static_cast<std::uint16_t>(static_cast<unsigned>(type) | (is_mandatory ? mandatory_record : 0u)));
    out.add(std::uint16_t{0});
    out.add(static_cast<std::uint32_t>(body.bytes.size()));
    body.bytes.resize(ModelBlockHeader::padded(body.bytes.size()), 0);
    out.append(body.bytes);
    ++count;
  };
  const ModelFacts& facts = records.facts;
  record(BlockRecord::commands, mandatory, static_cast<std::uint32_t>(facts.command_meaning), nothing,
         facts.command_lower, facts.command_upper);
  record(BlockRecord::clock, mandatory, nanoseconds(facts.sample_period_s), nanoseconds(facts.lag_removed_s));
  record(BlockRecord::window, mandatory, records.window_taps, std::uint32_t{records.causal});
  if (!records.column_names.empty()) {
    std::vector<std::string> texts;
    append_texts(texts, records.column_names, records.column_units);
    record(BlockRecord::columns, mandatory, closed(texts));
  }
  record(BlockRecord::allocation, mandatory, records.allocation);
  if (!records.base.empty()) record(BlockRecord::base, mandatory, records.base);
  if (facts.has_verdict) {
    record(BlockRecord::verdict, optional, judged_bits(facts.worse_than_mean, facts.beats_linear_regression), nothing);
  }
  record(BlockRecord::answer, mandatory, records.answer);
  record(BlockRecord::features, mandatory, closed(records.feature_texts));
  record(BlockRecord::outputs, mandatory, closed(records.output_texts));
  std::vector<std::uint64_t> airframe;
  each_number(records.airframe, [&](auto number) { airframe.push_back(double_bits(static_cast<double>(number))); });
  record(BlockRecord::vehicle, mandatory, airframe, records.flown_airframe, records.vehicle_name);
  if (!records.affine.empty()) record(BlockRecord::affine, optional, records.affine);
  if (const auto& trust = records.trust) {
    record(BlockRecord::trust, optional, double_bits(trust->squared_distance_limit),
           double_bits(trust->residual_factor), double_bits(trust->residual_limit),
           double_bits(trust->residual_cleared), double_bits(trust->update_period_s), trust->mean, trust->whitening);
  }
  if (facts.has_bias) record(BlockRecord::bias, optional, facts.bias_time_constants_s);
  const std::vector<unsigned char> provenance = closed(provenance_texts(records));
  if (provenance.size() > longest_provenance) {
    throw std::invalid_argument("export: name, training data and loss of a model are too long together");
  }
  record(BlockRecord::provenance, optional, provenance);
  Bytes all;
  all.add(count);
  all.add(static_cast<std::uint32_t>(out.bytes.size()));
  all.append(out.bytes);
  return std::move(all.bytes);
}

/// The fixed header of a block, but for its length and its own hash.
struct BlockCounts {
  std::uint64_t scalar_bytes, inputs, outputs, parameters, golden_vectors, training_rows, shape_hash,
      training_data_hash, contents_hash;
};

/// Header, records, scalars, checksum. Throws std::invalid_argument where a count does not fit its 32 bits.
PINNQUAD_BODY std::vector<unsigned char> whole_block(const BlockCounts& counts,
                                                     const std::vector<unsigned char>& records,
                                                     const std::vector<unsigned char>& scalars) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  const std::uint64_t length =
      ModelBlockHeader::size + records.size() + scalars.size() + ModelBlockHeader::checksum_size;
  if (counts.golden_vectors > most || counts.training_rows > most || length > most) {
    throw std::invalid_argument("export: a model block counts to 2^32 - 1");
  }
  LittleEndianBytes<float> out;
  out.add(model_block_magic);
  out.add(static_cast<std::uint32_t>(model_format_version));
  for (const std::uint64_t count : {length, counts.scalar_bytes, counts.inputs, counts.outputs, counts.parameters,
                                    counts.golden_vectors, counts.training_rows}) {
    out.add(static_cast<std::uint32_t>(count));
  }
  out.add(counts.shape_hash);
  out.add(counts.training_data_hash);
  out.add(counts.contents_hash);
  out.add(std::uint64_t{0});
  out.append(records);
  out.append(scalars);
  const std::uint64_t own = hash_of_block(out.bytes.data(), length);
  for (std::size_t byte = 0; byte < sizeof own; ++byte) {
    out.bytes[ModelBlockHeader::own_hash + byte] = static_cast<unsigned char>(own >> (8 * byte));
  }
  out.add(crc32(out.bytes.data(), out.bytes.size()));
  return std::move(out.bytes);
}

}  // namespace detail
}  // namespace pinnquad
