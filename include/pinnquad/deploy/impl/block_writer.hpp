// SPDX-License-Identifier: MIT
// Bodies of block_writer.hpp.
#pragma once

#include "pinnquad/deploy/block_writer.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::uint64_t double_bits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

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
