// SPDX-License-Identifier: MIT
// A model block whose bytes a test may change: aligned as a block must be, and exactly as long as it says, so that a
// sanitizer sees a read past its end.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "pinnquad/exported/model_block.hpp"

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

  /// Where the scalars begin: behind the header and, in version 2, the records.
  std::size_t scalars() const {
    const auto u32 = [this](std::size_t offset) { return detail::read_u32(bytes_.get() + offset); };
    const std::size_t records =
        u32(ModelBlockHeader::version) < 2 ? 0 : ModelBlockHeader::record_counts + u32(ModelBlockHeader::size + 4);
    return ModelBlockHeader::size + records;
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

  /// Makes the checksum right again.
  void seal() { set_u32(size_ - 4, crc32(bytes_.get(), size_ - 4)); }

 private:
  std::size_t size_;
  std::unique_ptr<unsigned char[]> bytes_;
};

}  // namespace pinnquad::test
