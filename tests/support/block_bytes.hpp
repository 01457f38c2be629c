// SPDX-License-Identifier: MIT
// A model block whose bytes and records a test may change: aligned as a block must be, and exactly as long as it says,
// so that a sanitizer sees a read past its end.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "pinnquad/exported/block_records.hpp"

namespace pinnquad::test {

class BlockBytes {
 public:
  explicit BlockBytes(const std::vector<unsigned char>& bytes) : BlockBytes(bytes, bytes.size()) {}

  /// The first `length` bytes. operator new aligns to 16.
  BlockBytes(const std::vector<unsigned char>& bytes, std::size_t length)
      : size_(length), bytes_(new unsigned char[length == 0 ? 1 : length]) {
    if (length > 0) std::memcpy(bytes_.get(), bytes.data(), length);
  }

  const unsigned char* data() const { return bytes_.get(); }
  std::size_t size() const { return size_; }
  unsigned char& operator[](std::size_t i) { return bytes_[i]; }

  void set_u32(std::size_t offset, std::uint32_t value) {
    for (std::size_t byte = 0; byte < 4; ++byte) {
      bytes_[offset + byte] = static_cast<unsigned char>((value >> (8 * byte)) & 0xffu);
    }
  }

  /// Where the scalars begin: behind the header and the records.
  std::size_t scalars() const {
    return detail::ModelBlockHeader::size + detail::ModelBlockHeader::record_counts +
           u32(detail::ModelBlockHeader::size + 4);
  }

  template <class Scalar>
  Scalar scalar(std::size_t index) const {
    Scalar value{};
    std::memcpy(&value, bytes_.get() + scalars() + index * sizeof value, sizeof value);
    return value;
  }
  template <class Scalar>
  void set_scalar(std::size_t index, Scalar value) {
    std::memcpy(bytes_.get() + scalars() + index * sizeof value, &value, sizeof value);
  }

  /// Makes the checksum right again, as one does who edits a block by hand.
  void seal_checksum() { set_u32(size_ - 4, crc32(bytes_.get(), size_ - 4)); }
  /// The same, and before it the block's own hash: as its writer would.
  void seal() {
    using Header = detail::ModelBlockHeader;
    if (size_ >= Header::size + Header::checksum_size) {
      const std::uint64_t hash = detail::hash_of_block(bytes_.get(), size_ / 4 * 4);
      set_u32(Header::own_hash, static_cast<std::uint32_t>(hash));
      set_u32(Header::own_hash + 4, static_cast<std::uint32_t>(hash >> 32));
    }
    seal_checksum();
  }

 private:
  std::uint32_t u32(std::size_t offset) const { return detail::read_u32(bytes_.get() + offset); }

  std::size_t size_;
  std::unique_ptr<unsigned char[]> bytes_;
};

/// One record as it stands in a block.
struct Record {
  unsigned type;  ///< with bit 15
  std::vector<unsigned char> bytes;
};

inline std::vector<Record> records_of(const std::vector<unsigned char>& block) {
  std::vector<Record> records;
  const unsigned char* at = block.data() + detail::ModelBlockHeader::size;
  std::uint32_t count = detail::read_u32(at);
  for (at += 8; count > 0; --count) {
    const std::uint32_t length = detail::read_u32(at + 4);
    records.push_back({detail::read_u32(at), {at + 8, at + 8 + length}});
    at += 8 + (length + 7) / 8 * 8;
  }
  return records;
}

/// Throws std::out_of_range for a type that is not there.
inline Record& find(std::vector<Record>& records, detail::BlockRecord type) {
  for (Record& record : records) {
    if ((record.type & 0x7fffu) == static_cast<unsigned>(type)) return record;
  }
  throw std::out_of_range("no such record");
}

/// The block with other records, its lengths and checksum right.
inline BlockBytes with_records(const std::vector<unsigned char>& block, const std::vector<Record>& records) {
  std::vector<unsigned char> all;
  const auto add_u32 = [](std::vector<unsigned char>& to, std::size_t value) {
    for (int byte = 0; byte < 4; ++byte) to.push_back(static_cast<unsigned char>(value >> (8 * byte) & 0xffu));
  };
  for (const Record& record : records) {
    add_u32(all, record.type);
    add_u32(all, record.bytes.size());
    all.insert(all.end(), record.bytes.begin(), record.bytes.end());
    all.resize((all.size() + 7) / 8 * 8, 0);
  }
  std::vector<unsigned char> result(block.begin(), block.begin() + detail::ModelBlockHeader::size);
  add_u32(result, records.size());
  add_u32(result, all.size());
  result.insert(result.end(), all.begin(), all.end());
  const auto scalars = static_cast<std::ptrdiff_t>(BlockBytes(block).scalars());
  result.insert(result.end(), block.begin() + scalars, block.end());
  BlockBytes made(result);
  made.set_u32(detail::ModelBlockHeader::length, static_cast<std::uint32_t>(result.size()));
  made.seal();
  return made;
}

}  // namespace pinnquad::test
