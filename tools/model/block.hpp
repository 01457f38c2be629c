// SPDX-License-Identifier: MIT
// A model block (exported/model_block.hpp) read on the ground, whatever its shape: its numbers, and which shape it is.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pinnquad/exported/model_agreement.hpp"
#include "pinnquad/exported/model_block.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

/// Scalars as double, which holds every float.
struct Block {
  std::string path;
  int inputs = 0, outputs = 0;
  bool is_double = false;
  std::size_t parameter_count = 0, golden_count = 0;
  std::uint32_t training_rows = 0;
  std::uint64_t shape_hash = 0, training_data_hash = 0;
  bool has_records = false;  ///< those of version 2, which follow; of version 1 they are as made
  double command_lower = 0, command_upper = 1, sample_period_s = 0, lag_removed_s = 0;
  std::uint32_t window_taps = 1;
  bool causal = true;
  std::vector<std::string> columns;    ///< name and unit of each
  std::vector<double> allocation;      ///< row-major
  std::string base;                    ///< description of what its outputs are added to; empty: nothing
  std::vector<int> slope_signs;        ///< rotor by rotor about x, y, z; none: it says none
  std::vector<double> residual_range;  ///< lower bounds, then upper ones; none: it says none
  std::vector<double> distance;        ///< means, triangle, limit; none: it says none
  bool has_judgement = false;          ///< it says how it was judged before it was exported
  std::uint32_t judged = 0;            ///< pinnquad::detail::judged_bits()
  std::vector<double> input_mean, input_deviation, output_mean, output_deviation, envelope_lower, envelope_upper;
  std::vector<double> golden_features, golden_commands;  ///< vector by vector
  std::vector<double> parameters;
};

namespace detail {

/// Bytes of a block: numbers in their order.
class BlockBytes {
 public:
  BlockBytes(const std::string& path, std::string bytes) : path_(path), bytes_(std::move(bytes)) {}

  const unsigned char* at(std::size_t offset) const {
    return reinterpret_cast<const unsigned char*>(bytes_.data()) + offset;
  }
  std::uint32_t u32(std::size_t offset) const { return pinnquad::detail::read_u32(at(offset)); }
  std::uint64_t u64(std::size_t offset) const { return pinnquad::detail::read_u64(at(offset)); }
  std::size_t size() const { return bytes_.size(); }
  double scalar(std::size_t offset, bool is_double) const {
    if (is_double) {
      const std::uint64_t bits = u64(offset);
      double value = 0;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    const std::uint32_t bits = u32(offset);
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return static_cast<double>(value);
  }
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw pinnquad::InputError(path_, 0, 0, expected, found);
  }

 private:
  const std::string& path_;
  std::string bytes_;
};

/// The records between header and scalars, each as open() wants it (exported/block_records.hpp). Gives the bytes that
/// they take.
inline std::size_t read_block_records(const BlockBytes& bytes, std::size_t end, Block& block) {
  using pinnquad::BlockRecord;
  using Header = pinnquad::ModelBlockHeader;
  const std::size_t first = Header::size;
  const auto broken = [&] { bytes.refuse("a model block", "records that do not fit"); };
  if (end - first < Header::record_counts) broken();
  const std::size_t whole = bytes.u32(first + 4);
  if (whole > end - first - Header::record_counts || whole % 8 != 0) broken();
  std::size_t at = first + Header::record_counts;
  const std::size_t last = at + whole;
  for (std::uint32_t i = 0; i < bytes.u32(first); ++i) {
    if (last - at < Header::record_head) broken();
    const std::uint32_t word = bytes.u32(at);
    const std::size_t length = bytes.u32(at + 4), body = at + Header::record_head;
    if (length > last - body || Header::padded(length) > last - body) broken();
    const std::uint32_t type = word & (pinnquad::mandatory_record - 1u);
    const std::size_t scalar = block.is_double ? 8 : 4;
    const auto sized = [&](std::size_t expected) {
      if (length != expected) broken();
    };
    const auto take = [&](std::size_t offset, std::size_t count) {
      std::vector<double> values;
      for (std::size_t k = 0; k < count; ++k) {
        values.push_back(bytes.scalar(body + offset + k * scalar, block.is_double));
        if (!std::isfinite(values.back())) bytes.refuse("numbers in its records", "NaN or Inf");
      }
      return values;
    };
    switch (static_cast<BlockRecord>(type)) {
      case BlockRecord::commands: {
        sized(8 + 2 * scalar);
        const std::vector<double> range = take(8, 2);
        block.command_lower = range[0];
        block.command_upper = range[1];
        break;
      }
      case BlockRecord::clock:
        sized(8);
        block.sample_period_s = 1e-9 * bytes.u32(body);
        block.lag_removed_s = 1e-9 * bytes.u32(body + 4);
        break;
      case BlockRecord::window:
        sized(8);
        block.window_taps = bytes.u32(body);
        block.causal = bytes.u32(body + 4) != 0;
        break;
      case BlockRecord::columns: {
        std::string text(reinterpret_cast<const char*>(bytes.at(body)), length);
        for (std::size_t zero = text.find('\0'); zero != std::string::npos; zero = text.find('\0')) {
          block.columns.push_back(text.substr(0, zero));
          text.erase(0, zero + 1);
        }
        if (!text.empty()) broken();
        break;
      }
      case BlockRecord::allocation:
        sized(16 * scalar);
        block.allocation = take(0, 16);
        break;
      case BlockRecord::base: block.base.assign(reinterpret_cast<const char*>(bytes.at(body)), length); break;
      case BlockRecord::verdict:
        sized(8);
        block.has_judgement = true;
        block.judged = bytes.u32(body);
        break;
      case BlockRecord::slope_signs:
        sized(3 * std::size_t(pinnquad::rotor_count));
        for (std::size_t k = 0; k < length; ++k) {
          block.slope_signs.push_back(static_cast<signed char>(*bytes.at(body + k)));
        }
        break;
      case BlockRecord::residual_range:
        sized(2 * static_cast<std::size_t>(block.outputs) * scalar);
        block.residual_range = take(0, 2 * static_cast<std::size_t>(block.outputs));
        break;
      case BlockRecord::distance: {
        const auto size = static_cast<std::size_t>(block.inputs);
        sized((size + pinnquad::detail::triangle(size) + 1) * scalar);
        block.distance = take(0, length / scalar);
        break;
      }
      default:
        if ((word & pinnquad::mandatory_record) != 0) bytes.refuse("records that are known", "a newer one");
    }
    at = body + Header::padded(length);
  }
  if (at != last) broken();
  block.has_records = true;
  return Header::record_counts + whole;
}

/// Refuses what no reader takes, whatever the shape (exported/model_agreement.hpp).
inline void require_sound(const BlockBytes& bytes, const Block& block) {
  using namespace pinnquad::detail;
  const auto inputs = static_cast<std::size_t>(block.inputs), outputs = static_cast<std::size_t>(block.outputs);
  for (const std::vector<double>* deviations : {&block.input_deviation, &block.output_deviation}) {
    for (const double deviation : *deviations) {
      if (!(deviation > 0)) bytes.refuse("standard deviations above 0", "one of " + pinnquad::number_text(deviation));
    }
  }
  const double *lower = block.envelope_lower.data(), *upper = block.envelope_upper.data();
  if (!is_envelope(block.input_mean.data(), block.input_deviation.data(), lower, upper, inputs)) {
    bytes.refuse("an envelope about the features' mean, as far as their standard deviation lets a training reach",
                 "another");
  }
  for (std::size_t row = 0; row < block.golden_count; ++row) {
    if (inside_envelope(lower, block.golden_features.data() + row * inputs, upper, inputs)) continue;
    bytes.refuse("golden vectors inside the envelope", "golden vector " + std::to_string(row + 1) + " outside of it");
  }
  if (!(block.command_lower <= block.command_upper)) bytes.refuse("a range of commands", "one that is upside down");
  if (!pinnquad::is_clock_time(block.sample_period_s) || !pinnquad::is_clock_time(block.lag_removed_s)) {
    bytes.refuse("a sample period and a removed lag of 0 to 4 s",
                 pinnquad::number_text(block.sample_period_s) + " and " + pinnquad::number_text(block.lag_removed_s));
  }
  for (const int sign : block.slope_signs) {
    if (sign < -1 || sign > 1) bytes.refuse("slope signs of -1, 0 or 1", std::to_string(sign));
  }
  for (std::size_t i = 0; i < block.residual_range.size() / 2; ++i) {
    if (block.residual_range[i] <= block.residual_range[outputs + i]) continue;
    bytes.refuse("a range of the residual", "one that is upside down");
  }
  if (block.distance.empty()) return;
  const double* mean = block.distance.data();
  if (!is_distance(mean, mean + inputs, block.distance.back(), lower, upper, inputs)) {
    bytes.refuse("statistics of a distance", "a mean outside the envelope, or a diagonal or a limit not above 0");
  }
}

}  // namespace detail

/// Checks the bytes of a block and takes them apart; `path` is for messages. Throws InputError: no block, cut short,
/// changed or of a newer version.
inline Block read_block(const std::string& path, const std::string& content) {
  using Header = pinnquad::ModelBlockHeader;
  Block block;
  block.path = path;
  const detail::BlockBytes bytes(path, content);
  const char* what = "a model block, as pinnquad train --block writes it";
  if (bytes.size() < Header::size + Header::checksum_size ||
      std::memcmp(bytes.at(0), pinnquad::model_block_magic.data(), pinnquad::model_block_magic.size()) != 0) {
    bytes.refuse(what, "something else");
  }
  const std::uint32_t version = bytes.u32(Header::version);
  if (version < pinnquad::oldest_model_block_version || version > pinnquad::model_block_version) {
    bytes.refuse("a model block of version 1 or 2", "version " + std::to_string(version));
  }
  const std::size_t length = bytes.u32(Header::length);
  if (length > bytes.size() || length < Header::size + Header::checksum_size) {
    bytes.refuse("a model block of " + std::to_string(length) + " bytes", std::to_string(bytes.size()));
  }
  const std::size_t end = length - Header::checksum_size;
  if (pinnquad::crc32(bytes.at(0), end) != bytes.u32(end)) bytes.refuse(what, "one whose checksum does not hold");
  const std::uint32_t scalar_bytes = bytes.u32(Header::scalar_bytes);
  const std::uint64_t inputs = bytes.u32(Header::inputs), outputs = bytes.u32(Header::outputs);
  const std::uint64_t parameters = bytes.u32(Header::parameters), golden = bytes.u32(Header::golden_vectors);
  for (const std::uint64_t count : {inputs, outputs, parameters, golden}) {
    if (count > length)
      bytes.refuse(what, "counts that do not fit its length");  // the products below do not wrap around
  }
  block.is_double = scalar_bytes == 8;
  block.inputs = static_cast<int>(inputs);
  block.outputs = static_cast<int>(outputs);
  block.training_rows = bytes.u32(Header::training_rows);
  block.shape_hash = bytes.u64(Header::shape_hash);
  block.training_data_hash = bytes.u64(Header::training_data_hash);
  std::size_t at = Header::size;
  if (version >= 2) at += detail::read_block_records(bytes, end, block);
  const std::uint64_t scalars =
      4 * inputs + 2 * outputs + golden * (inputs + std::uint64_t{pinnquad::rotor_count}) + parameters;
  if ((scalar_bytes != 4 && scalar_bytes != 8) || inputs == 0 || outputs == 0 || golden == 0 || end < at ||
      scalars != (end - at) / scalar_bytes || (end - at) % scalar_bytes != 0) {
    bytes.refuse(what, "counts that do not fit its length");
  }
  block.parameter_count = parameters;
  block.golden_count = golden;
  bool finite = true;
  const auto take = [&](std::vector<double>& into, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i, at += scalar_bytes) {
      into.push_back(bytes.scalar(at, block.is_double));
      finite = finite && std::isfinite(into.back());
    }
  };
  take(block.input_mean, inputs);
  take(block.input_deviation, inputs);
  take(block.output_mean, outputs);
  take(block.output_deviation, outputs);
  take(block.envelope_lower, inputs);
  take(block.envelope_upper, inputs);
  take(block.golden_features, golden * inputs);
  take(block.golden_commands, golden * std::uint64_t{pinnquad::rotor_count});
  take(block.parameters, parameters);
  if (!finite) bytes.refuse("numbers", "NaN or Inf");
  detail::require_sound(bytes, block);
  return block;
}

inline Block read_block(const std::string& path) { return read_block(path, pinnquad::file_text(path)); }

}  // namespace programs
