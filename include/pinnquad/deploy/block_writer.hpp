// SPDX-License-Identifier: MIT
// The bytes of a model block from what it says, whoever says it: a training, the types of an exported header
// (deploy/weight_file.hpp), or its text. Layout: exported/model_block.hpp; the same bytes on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/deploy/record_writer.hpp"
#include "pinnquad/exported/model_block.hpp"

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
  template <class Range>
  void add_bytes(const Range& range) {
    bytes.insert(bytes.end(), range.begin(), range.end());
  }
  /// With its closing 0.
  void add_text(std::string_view text) {
    add_bytes(text);
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
template <class Scalar>
std::vector<unsigned char> block_records(const WrittenRecords& records) {
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
    out.add_bytes(bytes.bytes);
    ++count;
  };
  const auto scalars = [](LittleEndianBytes& to, const std::vector<double>& values) {
    for (const double value : values) to.add(static_cast<Scalar>(value));
  };
  record(BlockRecord::commands, true, [&](LittleEndianBytes& to) {
    to.add_unsigned(static_cast<std::uint32_t>(records.command_meaning));
    to.add_unsigned(std::uint32_t{0});
    scalars(to, {records.command_lower, records.command_upper});
  });
  record(BlockRecord::clock, true, [&](LittleEndianBytes& to) {
    to.add_unsigned(nanoseconds(records.sample_period_s));
    to.add_unsigned(nanoseconds(records.lag_removed_s));
  });
  record(BlockRecord::window, true, [&](LittleEndianBytes& to) {
    to.add_unsigned(records.window_taps);
    to.add_unsigned(std::uint32_t{records.causal});
  });
  if (!records.column_names.empty()) {
    record(BlockRecord::columns, true, [&](LittleEndianBytes& to) {
      for (std::size_t i = 0; i < records.column_names.size(); ++i) {
        to.add_text(records.column_names[i]);
        to.add_text(records.column_units.at(i));
      }
    });
  }
  record(BlockRecord::allocation, true, [&](LittleEndianBytes& to) {
    for (const auto& row : records.allocation) scalars(to, {row.begin(), row.end()});
  });
  if (!records.base.empty()) {
    record(BlockRecord::base, true, [&](LittleEndianBytes& to) { to.add_bytes(records.base); });
  }
  if (records.judged) {
    record(BlockRecord::verdict, false, [&](LittleEndianBytes& to) {
      to.add_unsigned(*records.judged);
      to.add_unsigned(std::uint32_t{0});
    });
  }
  if (records.slope_signs) {
    record(BlockRecord::slope_signs, false, [&](LittleEndianBytes& to) {
      for (const TorqueSigns& rotor : *records.slope_signs) {
        for (const int sign : rotor) to.bytes.push_back(static_cast<unsigned char>(sign));
      }
    });
  }
  if (records.residual_range) {
    record(BlockRecord::residual_range, false, [&](LittleEndianBytes& to) {
      scalars(to, records.residual_range->lower);
      scalars(to, records.residual_range->upper);
    });
  }
  if (records.distance) {
    record(BlockRecord::distance, false, [&](LittleEndianBytes& to) {
      scalars(to, records.distance->mean);
      scalars(to, records.distance->inverse_cholesky);
      scalars(to, {records.distance->limit});
    });
  }
  LittleEndianBytes all;
  all.add_unsigned(count);
  all.add_unsigned(static_cast<std::uint32_t>(out.bytes.size()));
  all.add_bytes(out.bytes);
  return std::move(all.bytes);
}

/// The fixed header of a block, but for its length.
struct BlockCounts {
  std::uint64_t scalar_bytes, inputs, outputs, parameters, golden_vectors, training_rows, shape_hash,
      training_data_hash;
};

/// Header, records, scalars, checksum. Throws std::invalid_argument where a count does not fit its 32 bits.
inline std::vector<unsigned char> whole_block(const BlockCounts& counts, const std::vector<unsigned char>& records,
                                              const LittleEndianBytes& scalars) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  const std::uint64_t length =
      ModelBlockHeader::size + records.size() + scalars.bytes.size() + ModelBlockHeader::checksum_size;
  if (counts.golden_vectors > most || counts.training_rows > most || length > most) {
    throw std::invalid_argument("export: a model block counts to 2^32 - 1");
  }
  LittleEndianBytes out;
  out.add_bytes(model_block_magic);
  out.add_unsigned(model_block_version);
  for (const std::uint64_t count : {length, counts.scalar_bytes, counts.inputs, counts.outputs, counts.parameters,
                                    counts.golden_vectors, counts.training_rows}) {
    out.add_unsigned(static_cast<std::uint32_t>(count));
  }
  out.add_unsigned(counts.shape_hash);
  out.add_unsigned(counts.training_data_hash);
  out.add_bytes(records);
  out.add_bytes(scalars.bytes);
  out.add_unsigned(crc32(out.bytes.data(), out.bytes.size()));
  return std::move(out.bytes);
}

}  // namespace detail
}  // namespace pinnquad
