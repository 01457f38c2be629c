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
#include "pinnquad/exported/block_contents.hpp"
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

std::uint64_t double_bits(double value);

/// Where a model comes from and how it was judged: name and value in turn.
std::vector<std::string> provenance_texts(const WrittenRecords& records);

/// Numbers of a header that a block's other records round: the range of the commands, the clock's two, the allocation.
/// None where what those hold, and the airframe, give them to the bit: contents_hash is over them (exported/
/// block_contents.hpp). A tilted rotor's torque is a sum of products, which a compiler may round otherwise.
template <class Scalar>
std::vector<std::uint64_t> unrounded_numbers(const WrittenRecords& records) {
  const auto exact = [](double value, double held) { return double_bits(value) == double_bits(held); };
  const double lower = records.facts.command_lower, upper = records.facts.command_upper;
  const double period = records.facts.sample_period_s, lag = records.facts.lag_removed_s;
  bool same = exact(lower, static_cast<double>(static_cast<Scalar>(lower))) &&
              exact(upper, static_cast<double>(static_cast<Scalar>(upper))) &&
              exact(period, seconds_of(nanoseconds(period))) && exact(lag, seconds_of(nanoseconds(lag)));
  if (sizeof(Scalar) < sizeof(double)) {
    const AllocationMatrix<double> own = allocation(records.airframe);
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t k = 0; k < own[i].size(); ++k) same = same && exact(records.allocation[i][k], own[i][k]);
    }
    for (const auto& rotor : records.airframe.rotors) same = same && is_upright(rotor);
  }
  std::vector<std::uint64_t> numbers;
  if (same) return numbers;
  for (const double number : {lower, upper, period, lag}) numbers.push_back(double_bits(number));
  for (const auto& row : records.allocation) {
    for (const double entry : row) numbers.push_back(double_bits(entry));
  }
  return numbers;
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
  record(BlockRecord::contents, mandatory, records.contents_hash, std::uint64_t{0});
  const std::size_t own = out.bytes.size() - 8;  // of the hash over all records, when they are there
  if (!records.affine.empty()) record(BlockRecord::affine, optional, records.affine);
  if (const auto& trust = records.trust) {
    record(BlockRecord::trust, optional, double_bits(trust->squared_distance_limit),
           double_bits(trust->residual_factor), double_bits(trust->residual_limit),
           double_bits(trust->residual_cleared), double_bits(trust->update_period_s), trust->mean, trust->whitening);
  }
  if (const auto numbers = unrounded_numbers<Scalar>(records); !numbers.empty()) {
    record(BlockRecord::unrounded, optional, numbers);
  }
  if (facts.has_bias) record(BlockRecord::bias, optional, facts.bias_time_constants_s);
  const std::vector<unsigned char> provenance = closed(provenance_texts(records));
  if (provenance.size() > longest_provenance) {
    throw std::invalid_argument("export: name, training data and loss of a model are too long together");
  }
  record(BlockRecord::provenance, optional, provenance);
  Bytes hash;
  hash.add(hash_of_records(out.bytes.data(), out.bytes.size(), out.bytes.data() + own));
  std::copy(hash.bytes.begin(), hash.bytes.end(), out.bytes.begin() + static_cast<std::ptrdiff_t>(own));
  Bytes all;
  all.add(count);
  all.add(static_cast<std::uint32_t>(out.bytes.size()));
  all.append(out.bytes);
  return std::move(all.bytes);
}

/// The fixed header of a block, but for its length.
struct BlockCounts {
  std::uint64_t scalar_bytes, inputs, outputs, parameters, golden_vectors, training_rows, shape_hash,
      training_data_hash;
};

/// Header, records, scalars, checksum. Throws std::invalid_argument where a count does not fit its 32 bits.
std::vector<unsigned char> whole_block(const BlockCounts& counts, const std::vector<unsigned char>& records,
                                       const std::vector<unsigned char>& scalars);

}  // namespace detail
}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/block_writer.hpp"
#endif
