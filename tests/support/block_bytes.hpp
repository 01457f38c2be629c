// SPDX-License-Identifier: MIT
// A model block whose bytes and records a test may change: aligned as a block must be, and exactly as long as it says,
// so that a sanitizer sees a read past its end.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "pinnquad/exported/block_contents.hpp"

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
    return ModelBlockHeader::size + ModelBlockHeader::record_counts + u32(ModelBlockHeader::size + 4);
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
  /// The same, and before it the hash over the contents where the block has one: as its writer would.
  void seal() {
    const std::uint32_t scalar = size_ < ModelBlockHeader::size ? 0 : u32(ModelBlockHeader::scalar_bytes);
    if (scalar == 4) seal_contents<float>();
    if (scalar == 8) seal_contents<double>();
    seal_checksum();
  }

 private:
  std::uint32_t u32(std::size_t offset) const { return detail::read_u32(bytes_.get() + offset); }

  template <class Scalar>
  void seal_contents() {
    using Header = ModelBlockHeader;
    detail::BlockRecords<Scalar> records;
    std::size_t record_bytes = 0;
    const std::size_t inputs = u32(Header::inputs), outputs = u32(Header::outputs),
                      parameters = u32(Header::parameters), golden = u32(Header::golden_vectors),
                      behind = size_ - Header::size - Header::checksum_size;
    if (size_ < Header::size + Header::checksum_size || inputs > 10000 || outputs > 10000 || golden > size_) return;
    // a record that is refused leaves what was read before it: such a block is refused for that
    if (detail::read_records(bytes_.get() + Header::size, behind, inputs, outputs, records, record_bytes) !=
            Status::ok ||
        !records.describes_itself()) {
      return;
    }
    const std::size_t scalars = 4 * inputs + 2 * outputs + golden * (inputs + rotor_count) + parameters;
    if (parameters > size_ || behind - record_bytes != scalars * sizeof(Scalar)) return;
    Airframe<double> airframe{};
    const unsigned char* from = records.airframe;
    each_number(airframe, [&](auto& number) {
      double value = 0;
      std::memcpy(&value, from, sizeof value);
      from += sizeof value;
      if constexpr (std::is_same_v<std::decay_t<decltype(number)>, Spin>) {
        number = value < 0 ? Spin::clockwise : Spin::counter_clockwise;
      } else {
        number = value;
      }
    });
    const AllocationMatrix<double> own = allocation(airframe);
    const detail::TorqueSigns signs = motor_torque_signs(airframe);
    const detail::BlockVehicle vehicle{own[0].data(), signs[0].data()};
    const auto* first = reinterpret_cast<const Scalar*>(bytes_.get() + Header::size + record_bytes);
    const detail::BlockNumbers<Scalar> numbers{first,
                                               inputs,
                                               outputs,
                                               golden,
                                               parameters,
                                               u32(Header::training_rows),
                                               detail::read_u64(bytes_.get() + Header::training_data_hash)};
    const std::uint64_t hash = detail::BlockContents<Scalar>(records, numbers, vehicle).hash();
    std::size_t at = Header::size + Header::record_counts;
    while ((u32(at) & 0x7fffu) != static_cast<unsigned>(BlockRecord::contents)) {
      at += Header::record_head + Header::padded(u32(at + 4));
    }
    set_u32(at + 8, static_cast<std::uint32_t>(hash));
    set_u32(at + 12, static_cast<std::uint32_t>(hash >> 32));
    if (records.records_hash == nullptr) return;
    const std::uint64_t whole = detail::hash_of_records(records.whole, records.whole_bytes, records.records_hash);
    set_u32(at + 16, static_cast<std::uint32_t>(whole));
    set_u32(at + 20, static_cast<std::uint32_t>(whole >> 32));
  }

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
  const unsigned char* at = block.data() + ModelBlockHeader::size;
  std::uint32_t count = detail::read_u32(at);
  for (at += 8; count > 0; --count) {
    const std::uint32_t length = detail::read_u32(at + 4);
    records.push_back({detail::read_u32(at), {at + 8, at + 8 + length}});
    at += 8 + (length + 7) / 8 * 8;
  }
  return records;
}

/// Throws std::out_of_range for a type that is not there.
inline Record& find(std::vector<Record>& records, BlockRecord type) {
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
  std::vector<unsigned char> result(block.begin(), block.begin() + ModelBlockHeader::size);
  add_u32(result, records.size());
  add_u32(result, all.size());
  result.insert(result.end(), all.begin(), all.end());
  const auto scalars = static_cast<std::ptrdiff_t>(BlockBytes(block).scalars());
  result.insert(result.end(), block.begin() + scalars, block.end());
  BlockBytes made(result);
  made.set_u32(ModelBlockHeader::length, static_cast<std::uint32_t>(result.size()));
  made.seal();
  return made;
}

}  // namespace pinnquad::test
