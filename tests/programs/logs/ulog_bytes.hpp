// SPDX-License-Identifier: MIT
// ULog files byte by byte, as the format's description has them: nothing of the reader is used, so that both can be
// wrong only in the same way by chance.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pinnquad_test {

/// Values one behind the other, least byte first.
class Bytes {
 public:
  Bytes& u8(unsigned value) { return whole(value, 1); }
  Bytes& u16(unsigned value) { return whole(value, 2); }
  Bytes& u32(std::uint64_t value) { return whole(value, 4); }
  Bytes& u64(std::uint64_t value) { return whole(value, 8); }
  Bytes& f32(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return whole(bits, 4);
  }
  Bytes& f64(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return whole(bits, 8);
  }
  Bytes& text(const std::string& value) {
    text_ += value;
    return *this;
  }
  Bytes& zeros(std::size_t count) {
    text_.append(count, '\0');
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  Bytes& whole(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) text_ += static_cast<char>((value >> (8 * i)) % 256);
    return *this;
  }
  std::string text_;
};

/// A log as a logger writes it: definitions first.
class UlogBytes {
 public:
  explicit UlogBytes(unsigned version = 1, std::uint64_t start_us = 0) {
    text_ = Bytes().text("ULog").u8(1).u8(0x12).u8(0x35).u8(version).u64(start_us).str();
  }

  UlogBytes& message(char type, const std::string& content) {
    starts_.push_back(text_.size());
    text_ += Bytes().u16(static_cast<unsigned>(content.size())).text(std::string(1, type)).text(content).str();
    return *this;
  }
  UlogBytes& flags(unsigned compatible, unsigned incompatible, const std::vector<std::uint64_t>& offsets = {},
                   std::size_t more = 0) {
    Bytes bytes;
    bytes.u8(compatible).zeros(7).u8(incompatible).zeros(7);
    for (std::size_t i = 0; i < 3; ++i) bytes.u64(i < offsets.size() ? offsets[i] : 0);
    return message('B', bytes.zeros(more).str());
  }
  UlogBytes& format(const std::string& text) { return message('F', text); }
  UlogBytes& keyed(char type, const std::string& key, const Bytes& value) {
    return message(type, Bytes().u8(static_cast<unsigned>(key.size())).text(key).text(value.str()).str());
  }
  UlogBytes& topic(unsigned instance, unsigned id, const std::string& name) {
    return message('A', Bytes().u8(instance).u16(id).text(name).str());
  }
  UlogBytes& data(unsigned id, const Bytes& content) { return message('D', Bytes().u16(id).text(content.str()).str()); }
  UlogBytes& sync() {
    return message('S', Bytes().u8(0x2f).u8(0x73).u8(0x13).u8(0x20).u8(0x25).u8(0x0c).u8(0xbb).u8(0x12).str());
  }
  UlogBytes& dropout(unsigned milliseconds) { return message('O', Bytes().u16(milliseconds).str()); }
  UlogBytes& said(char level, std::uint64_t time_us, const std::string& text) {
    return message('L', Bytes().text(std::string(1, level)).u64(time_us).text(text).str());
  }
  UlogBytes& raw(const std::string& bytes) {
    text_ += bytes;
    return *this;
  }

  const std::string& str() const { return text_; }
  /// Where each message begins.
  const std::vector<std::size_t>& starts() const { return starts_; }

 private:
  std::string text_;
  std::vector<std::size_t> starts_;
};

}  // namespace pinnquad_test
