// SPDX-License-Identifier: MIT
// A mutator of texts of lines, `key = value`: of changed bytes alone hardly one file in a thousand is still TOML.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace pinnquad_test {

/// Drops, repeats or swaps lines, gives one the value of another or another number; or leaves it to libFuzzer. Every
/// other time it begins with a text that was accepted, for most that a fuzzer keeps are refused.
class LineMutator {
 public:
  void accepted(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t most = 256;
    std::string text(reinterpret_cast<const char*>(data), size);
    if (accepted_.size() < most) {
      accepted_.push_back(std::move(text));
    } else {
      accepted_[next_++ % most] = std::move(text);
    }
  }

  std::size_t operator()(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) const {
    std::minstd_rand engine(seed);
    const auto any = [&engine](std::size_t count) { return std::size_t{engine()} % count; };
    if (!accepted_.empty() && any(2) == 0) {
      const std::string& text = accepted_[any(accepted_.size())];
      size = std::min(text.size(), max_size);
      std::memcpy(data, text.data(), size);
    }
    std::vector<std::string> lines(1);
    for (std::size_t i = 0; i < size; ++i) {
      lines.back() += static_cast<char>(data[i]);
      if (data[i] == '\n') lines.emplace_back();
    }
    const std::size_t at = any(lines.size()), other = any(lines.size());
    std::string& line = lines[at];
    const auto value_of = [](const std::string& whole) { return std::min(whole.find('=') + 1, whole.size()); };
    switch (any(8)) {
      case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
      case 1: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), std::string(lines[other])); break;
      case 2: std::swap(line, lines[other]); break;
      case 3: line = line.substr(0, value_of(line)) + lines[other].substr(value_of(lines[other])); break;
      case 4:
      case 5:
      case 6: {
        const std::size_t from = line.find_first_of("-0123456789", value_of(line) + any(line.size() + 1) / 2);
        if (from == std::string::npos) return LLVMFuzzerMutate(data, size, max_size);
        const std::size_t to = std::min(line.find_first_not_of("+-.0123456789e_", from), line.size());
        line.replace(from, to - from, another(line.substr(from, to - from), any(24)));
        break;
      }
      default: return LLVMFuzzerMutate(data, size, max_size);
    }
    std::string text;
    for (const std::string& one : lines) text += one;
    size = std::min(text.size(), max_size);
    std::memcpy(data, text.data(), size);
    return size;
  }

 private:
  /// A number near another, or one that a reader should look at twice.
  static std::string another(const std::string& number, std::size_t way) {
    constexpr double factors[] = {0.5, 0.9, 0.99, 1.01, 1.1, 2, 10, 0.1, -1};
    constexpr const char* extremes[] = {"0",    "-1",    "1",      "0.5",    "nan", "inf",
                                        "-inf", "1e300", "-1e300", "1e-300", "256", "''"};
    if (way >= std::size(factors)) return extremes[(way - std::size(factors)) % std::size(extremes)];
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", factors[way] * std::strtod(number.c_str(), nullptr));
    return std::string(text) + (std::strpbrk(text, ".en") == nullptr ? ".0" : "");
  }

  std::vector<std::string> accepted_;
  std::size_t next_ = 0;
};

}  // namespace pinnquad_test
