// SPDX-License-Identifier: MIT
// The layout of a model block: a model's numbers in memory (a flash partition, a file read into RAM), little-endian.
// Stated once, for deploy/weight_file.hpp, which writes it, and exported/model_view.hpp, which reads it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/exported/checksum.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/model/description.hpp"

namespace pinnquad {

/// The first bytes of a block.
inline constexpr std::array<unsigned char, 8> model_block_magic = {'P', 'I', 'N', 'N', 'Q', 'U', 'A', 'D'};

/// Where a block may begin: at multiples of this many bytes, so that its scalars can be read in place.
inline constexpr std::size_t model_block_alignment = 8;

namespace detail {

/// Byte offsets of the header's fields, and what they hold:
///   magic, u32 model_format_version, u32 length of the whole block, u32 bytes of a scalar (4 or 8, IEEE 754),
///   u32 inputs, u32 outputs, u32 parameters, u32 golden vectors, u32 training rows, u64 shape_hash(),
///   u64 training data hash, u64 contents_hash of the header beside it (exported/contents_hash.hpp), u64
///   hash_of_block().
/// The records follow: u32 number of them, u32 bytes of them all, and each of them. Scalars follow:
/// input mean and standard deviation, output mean and standard deviation, envelope lower and upper, golden features,
/// golden commands, parameters (row-major, as in an exported header). The last four bytes are the CRC-32 of all before
/// them.
struct ModelBlockHeader {
  static constexpr std::size_t version = 8;
  static constexpr std::size_t length = 12;
  static constexpr std::size_t scalar_bytes = 16;
  static constexpr std::size_t inputs = 20;
  static constexpr std::size_t outputs = 24;
  static constexpr std::size_t parameters = 28;
  static constexpr std::size_t golden_vectors = 32;
  static constexpr std::size_t training_rows = 36;
  static constexpr std::size_t shape_hash = 40;
  static constexpr std::size_t training_data_hash = 48;
  static constexpr std::size_t contents_hash = 56;
  static constexpr std::size_t own_hash = 64;
  static constexpr std::size_t size = 72;
  static constexpr std::size_t checksum_size = 4;
  static constexpr std::size_t record_counts = 8;  ///< number of the records and bytes of them all, before the first
  static constexpr std::size_t record_head = 8;    ///< of each record: its type and length
  /// Bytes of a record behind its head.
  static PINNQUAD_ALWAYS_INLINE constexpr std::size_t padded(std::size_t record_length) noexcept {
    return (record_length + 7) / 8 * 8;
  }
};

/// Records give the numbers of a block their meaning. Each is u16 type (bit 15: mandatory), u16 0, u32 length, bytes,
/// zeros up to a multiple of 8. A reader refuses a mandatory record that it does not know and skips any other one.
/// Here are the types and the bytes of each; "scalar" is the block's.
enum class BlockRecord : std::uint16_t {
  commands = 1,    ///< u32 CommandMeaning, u32 0, scalars lower and upper command
  clock = 2,       ///< u32 sample period in ns (0: not said), u32 lag removed in ns
  window = 3,      ///< u32 taps, u32 1 if causal
  columns = 4,     ///< name and unit of each extra column, every text closed by a 0
  allocation = 5,  ///< 16 scalars, row-major
  base = 6,        ///< description of what the outputs add to
  verdict = 7,     ///< u32 judged_bits(), u32 0; optional
  // with those a block describes itself (exported/run_time_model.hpp)
  answer = 8,    ///< description of the predictor (model/description.hpp)
  features = 9,  ///< name and unit of each feature, every text closed by a 0
  outputs = 10,  ///< description of the output schema, then name and unit of each output, every text closed by a 0
  vehicle = 11,  ///< each_number() of the airframe in f64, the same in scalars as it flies, its name
  trust = 12,  ///< f64 limit of the squared distance; factor, limit, cleared, period of the command residual; scalars:
               ///< means of all features, whitening triangle column by column; optional
  provenance = 13,  ///< name and value in turn, every text closed by a 0; optional
  affine = 14,      ///< scalars: commands at outputs 0, then by each output, of a schema that no library has; optional
  bias = 15,        ///< scalars: time constants of the bias of the four signed sums, s, 0 none is learnt; optional
};

/// Bit of a record's type: a reader that does not know the record refuses the block.
inline constexpr std::uint16_t mandatory_record = 0x8000;

inline constexpr std::uint32_t block_record_types = 15;

/// The most bytes of a block's provenance.
inline constexpr std::uint32_t longest_provenance = 4096;

PINNQUAD_ALWAYS_INLINE constexpr std::uint32_t read_u32(const unsigned char* from) noexcept {
  return std::uint32_t{from[0]} | std::uint32_t{from[1]} << 8 | std::uint32_t{from[2]} << 16 |
         std::uint32_t{from[3]} << 24;
}
PINNQUAD_ALWAYS_INLINE constexpr std::uint64_t read_u64(const unsigned char* from) noexcept {
  return std::uint64_t{read_u32(from)} | std::uint64_t{read_u32(from + 4)} << 32;
}

inline namespace PINNQUAD_INSTRUCTION_SET {

/// How a model was judged before it was exported (evaluation/errors.hpp): bit 0, worse than the mean, not for flight;
/// bit 1, better than a linear regression.
constexpr std::uint32_t judged_bits(bool worse_than_mean, bool beats_linear_regression) noexcept {
  return (worse_than_mean ? 1u : 0u) | (beats_linear_regression ? 2u : 0u);
}

/// Bytes of each BlockRecord in a block of such scalars, 0 for one of texts.
struct RecordLengths {
  std::uint32_t of[block_record_types + 1];
};
constexpr RecordLengths record_lengths(std::uint32_t scalar, std::uint32_t inputs, std::uint32_t outputs) noexcept {
  constexpr std::uint32_t rotors = rotor_count;
  return {{0, 8 + 2 * scalar, 8, 8, 0, 4 * rotors * scalar, 0, 8, 0, 0, 0, 0,
           5 * 8 + (inputs + std::uint32_t(triangle(inputs))) * scalar, 0, rotors * (1 + outputs) * scalar,
           4 * scalar}};
}

/// The bytes of texts, each closed by a 0.
template <class... Lists>
constexpr std::size_t texts_length(const Lists&... lists) noexcept {
  std::size_t length = 0;
  const auto add = [&length](const auto& list) {
    for (const char* text : list) length += std::string_view(text).size() + 1;
  };
  (add(lists), ...);
  return length;
}
/// The bytes of a record of extra columns.
template <class Features>
constexpr std::size_t columns_length() noexcept {
  return texts_length(extra_column_names<Features>, extra_column_units<Features>);
}
template <class Features>
constexpr auto column_bytes() noexcept {
  DescriptionLetters<columns_length<Features>()> bytes;
  for (std::size_t i = 0; i < extra_column_names<Features>.size(); ++i) {
    for (const std::string_view text : {extra_column_names<Features>[i], extra_column_units<Features>[i]}) {
      for (const char letter : text) bytes.take(letter);
      bytes.take('\0');
    }
  }
  return bytes;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// Where the scalars of a block for this shape stand, counted in scalars from the end of the header and the records.
template <class Shape>
struct ModelBlockLayout {
  static constexpr std::size_t inputs = Shape::Network::inputs;
  static constexpr std::size_t outputs = Shape::Network::outputs;
  static constexpr std::size_t parameter_count = Shape::Network::parameter_count;
  static constexpr std::size_t commands = rotor_count;

  static constexpr std::size_t input_mean = 0;
  static constexpr std::size_t input_deviation = inputs;
  static constexpr std::size_t output_mean = 2 * inputs;
  static constexpr std::size_t output_deviation = output_mean + outputs;
  static constexpr std::size_t envelope_lower = output_deviation + outputs;
  static constexpr std::size_t envelope_upper = envelope_lower + inputs;
  static constexpr std::size_t golden_features = envelope_upper + inputs;
  static PINNQUAD_ALWAYS_INLINE constexpr std::size_t golden_commands(std::size_t golden) noexcept {
    return golden_features + golden * inputs;
  }
  static PINNQUAD_ALWAYS_INLINE constexpr std::size_t parameters(std::size_t golden) noexcept {
    return golden_commands(golden) + golden * commands;
  }
  /// Bytes of the whole block without its records. In 64 bits: a golden count from a broken header must not wrap
  /// around.
  static PINNQUAD_ALWAYS_INLINE constexpr std::uint64_t length(std::uint64_t golden) noexcept {
    const std::uint64_t scalars = golden_features + golden * (inputs + commands) + parameter_count;
    return detail::ModelBlockHeader::size + scalars * sizeof(typename Shape::Scalar) +
           detail::ModelBlockHeader::checksum_size;
  }
  /// Bytes of the records, counts included, that no block of this library exceeds: room for one in a buffer is
  /// length(golden) and this.
  static constexpr std::size_t most_record_bytes() noexcept {
    using Features = typename Shape::Features;
    using Map = OutputMap<typename Shape::Outputs>;
    using Base = typename detail::BaseOf<typename Shape::Outputs>::type;
    constexpr auto lengths = detail::record_lengths(sizeof(typename Shape::Scalar), inputs, outputs);
    std::size_t bytes = detail::ModelBlockHeader::record_counts;
    for (std::uint32_t type = 1; type <= detail::block_record_types; ++type) {
      std::size_t length = lengths.of[type];
      switch (detail::BlockRecord(type)) {
        case detail::BlockRecord::columns: length = detail::columns_length<Features>(); break;
        case detail::BlockRecord::base: length = detail::description_length<Base>(); break;
        case detail::BlockRecord::answer: length = detail::description_length<typename Shape::Network>(); break;
        case detail::BlockRecord::features: length = detail::texts_length(Features::names, Features::units); break;
        case detail::BlockRecord::outputs:
          length =
              detail::description_length<typename Shape::Outputs>() + 1 + detail::texts_length(Map::names, Map::units);
          break;
        case detail::BlockRecord::vehicle:
          length = airframe_number_count * (8 + sizeof(typename Shape::Scalar)) +
                   std::string_view(Shape::Vehicle::name).size();
          break;
        case detail::BlockRecord::provenance: length = detail::longest_provenance; break;
        default: break;
      }
      bytes += detail::ModelBlockHeader::record_head + detail::ModelBlockHeader::padded(length);
    }
    return bytes;
  }
};

namespace detail {

/// The numbers that a reader expects in a block's header.
struct ExpectedBlock {
  std::uint32_t scalar_bytes, inputs, outputs, parameters;
  std::uint64_t shape_hash;
};

inline namespace PINNQUAD_INSTRUCTION_SET {

inline bool has_magic(const unsigned char* block) noexcept {
  const unsigned char* magic = first_of<unsigned char>(model_block_magic);
  bool same = true;
  for (std::size_t i = 0; i < sizeof model_block_magic; ++i) same &= block[i] == magic[i];
  return same;
}

/// The checks of a block that need no scalar and no shape, in this order: place and length (`block_truncated`), magic
/// and format (`block_incompatible`), length stated (`block_truncated`), checksum (`block_corrupt`).
inline Status check_bytes(const unsigned char* block, std::size_t available) noexcept {
  using Header = ModelBlockHeader;
  if (block == nullptr || reinterpret_cast<std::uintptr_t>(block) % model_block_alignment != 0) {
    return Status::block_truncated;
  }
  if (available < Header::size + Header::checksum_size) return Status::block_truncated;
  if (!has_magic(block)) return Status::block_incompatible;
  if (read_u32(block + Header::version) != std::uint32_t(model_format_version)) return Status::block_incompatible;
  const std::size_t length = read_u32(block + Header::length);
  if (length > available) return Status::block_truncated;
  if (length < Header::size + Header::checksum_size) return Status::block_corrupt;
  const std::size_t checked = length - Header::checksum_size;
  return crc32(block, checked) == read_u32(block + checked) ? Status::ok : Status::block_corrupt;
}

/// The same, and the shape (`block_incompatible`).
inline Status check_block(const unsigned char* block, std::size_t available, const ExpectedBlock& expected) noexcept {
  using Header = ModelBlockHeader;
  const Status checked = check_bytes(block, available);
  if (checked != Status::ok) return checked;
  const bool fits = read_u32(block + Header::scalar_bytes) == expected.scalar_bytes &&
                    read_u32(block + Header::inputs) == expected.inputs &&
                    read_u32(block + Header::outputs) == expected.outputs &&
                    read_u32(block + Header::parameters) == expected.parameters &&
                    read_u64(block + Header::shape_hash) == expected.shape_hash;
  return fits ? Status::ok : Status::block_incompatible;
}

/// FNV-1a over the words of 32 bits of a block, but for this hash and the checksum: an edited block is refused, though
/// its checksum was made again. `length`: of the block, a multiple of 4.
inline std::uint64_t hash_of_block(const unsigned char* block, std::size_t length) noexcept {
  using Header = ModelBlockHeader;
  std::uint64_t hash = Fnv1a{}.hash;
  for (std::size_t at = 0; at < length - Header::checksum_size; at += 4) {
    if (at == Header::own_hash) at = Header::size;
    hash = (hash ^ read_u32(block + at)) * ConstantHash::prime;
  }
  return hash;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
