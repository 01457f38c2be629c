// SPDX-License-Identifier: MIT
// A model block (inference/model_block.hpp) read on the ground, whatever its shape: its numbers, and which shape it is.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pinnquad/data/text_file.hpp"
#include "pinnquad/inference/model_block.hpp"

namespace programs {

/// Scalars as double, which holds every float.
struct Block {
  std::string path;
  int inputs = 0, outputs = 0;
  bool is_double = false;
  std::size_t parameter_count = 0, golden_count = 0;
  std::uint32_t training_rows = 0;
  std::uint64_t shape_hash = 0, training_data_hash = 0;
  std::string base;            ///< description of what its outputs are added to; empty: nothing
  bool has_judgement = false;  ///< it says how it was judged before it was exported
  std::uint32_t judged = 0;    ///< bits of pinnquad::Judged
  std::vector<double> input_mean, input_spread, output_mean, output_spread, envelope_lower, envelope_upper;
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

/// The records between header and scalars: those that are of use here. Gives the bytes that they take.
inline std::size_t read_block_records(const BlockBytes& bytes, std::size_t end, Block& block) {
  using pinnquad::BlockRecord;
  using Layout = pinnquad::BlockRecordLayout;
  const std::size_t first = pinnquad::ModelBlockHeader::size;
  const auto broken = [&] { bytes.refuse("a model block", "records that do not fit"); };
  if (end - first < Layout::counts) broken();
  const std::size_t whole = bytes.u32(first + 4);
  if (whole > end - first - Layout::counts || whole % 8 != 0) broken();
  std::size_t at = first + Layout::counts;
  const std::size_t last = at + whole;
  for (std::uint32_t i = 0; i < bytes.u32(first); ++i) {
    if (last - at < Layout::head) broken();
    const std::uint32_t word = bytes.u32(at);
    const std::size_t length = bytes.u32(at + 4), body = at + Layout::head;
    if (length > last - body || Layout::padded(length) > last - body) broken();
    const std::uint32_t type = word & (pinnquad::mandatory_record - 1u);
    switch (static_cast<BlockRecord>(type)) {
      case BlockRecord::window:
        if (length != 8) broken();
        break;
      case BlockRecord::base: block.base.assign(reinterpret_cast<const char*>(bytes.at(body)), length); break;
      case BlockRecord::verdict:
        if (length != 8) broken();
        block.has_judgement = true;
        block.judged = bytes.u32(body);
        break;
      case BlockRecord::columns:
      case BlockRecord::commands:
      case BlockRecord::clock:
      case BlockRecord::allocation:
      case BlockRecord::slope_signs:
      case BlockRecord::residual_range:
      case BlockRecord::distance: break;
      default:
        if ((word & pinnquad::mandatory_record) != 0) bytes.refuse("records that are known", "a newer one");
    }
    at = body + Layout::padded(length);
  }
  if (at != last) broken();
  return Layout::counts + whole;
}

}  // namespace detail

/// Checks the bytes of a block and takes them apart; `path` is for messages. Throws InputError: no block, cut short, changed or of a newer version.
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
  block.is_double = scalar_bytes == 8;
  block.training_rows = bytes.u32(Header::training_rows);
  block.shape_hash = bytes.u64(Header::shape_hash);
  block.training_data_hash = bytes.u64(Header::training_data_hash);
  std::size_t at = Header::size;
  if (version >= 2) at += detail::read_block_records(bytes, end, block);
  for (const std::uint64_t count : {inputs, outputs, parameters, golden}) {
    if (count > length)
      bytes.refuse(what, "counts that do not fit its length");  // the products below do not wrap around
  }
  const std::uint64_t scalars =
      4 * inputs + 2 * outputs + golden * (inputs + std::uint64_t{pinnquad::rotor_count}) + parameters;
  if ((scalar_bytes != 4 && scalar_bytes != 8) || inputs == 0 || outputs == 0 || golden == 0 || end < at ||
      scalars != (end - at) / scalar_bytes || (end - at) % scalar_bytes != 0) {
    bytes.refuse(what, "counts that do not fit its length");
  }
  block.inputs = static_cast<int>(inputs);
  block.outputs = static_cast<int>(outputs);
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
  take(block.input_spread, inputs);
  take(block.output_mean, outputs);
  take(block.output_spread, outputs);
  take(block.envelope_lower, inputs);
  take(block.envelope_upper, inputs);
  take(block.golden_features, golden * inputs);
  take(block.golden_commands, golden * std::uint64_t{pinnquad::rotor_count});
  take(block.parameters, parameters);
  if (!finite) bytes.refuse("numbers", "NaN or Inf");
  return block;
}

inline Block read_block(const std::string& path) { return read_block(path, pinnquad::file_text(path)); }

}  // namespace programs
