// SPDX-License-Identifier: MIT
// A file as a reader goes through it, from its begin to its end: a part of it is in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad::logs {

class FileWindow {
 public:
  /// Bytes that are in memory already.
  explicit FileWindow(std::string_view bytes) : part_(bytes), size_(bytes.size()) {}
  /// Throws InputError as TextFile does, and for a file that shrinks while it is read.
  explicit FileWindow(const std::string& path) : file_(path), size_(std::filesystem::file_size(path)) {}

  std::uint64_t size() const noexcept { return size_; }

  /// The bytes from `place` on: `count` of them, fewer at the file's end. They are there until the next call, whose
  /// place is not before this one.
  std::string_view at(std::uint64_t place, std::size_t count) {
    count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - place));
    if (place - begin_ + count > part_.size()) read_on(place, count);
    return part_.substr(static_cast<std::size_t>(place - begin_), count);
  }

  /// Where the bytes are found first, `from` or behind it; `end` where they do not stand before it.
  std::uint64_t find(std::string_view bytes, std::uint64_t from, std::uint64_t end) {
    while (end - from >= bytes.size()) {
      const std::string_view part = at(from, static_cast<std::size_t>(std::min<std::uint64_t>(end - from, looked_at)));
      const std::size_t found = part.find(bytes);
      if (found != std::string_view::npos) return from + found;
      from += part.size() - (bytes.size() - 1);
    }
    return end;
  }

  /// Most that one call of at() may ask for.
  static constexpr std::size_t most = std::size_t{1} << 18;

 private:
  static constexpr std::size_t looked_at = most, held = 4 * most;

  /// Lets go of what is before `place`.
  void read_on(std::uint64_t place, std::size_t count) {
    const auto behind = static_cast<std::size_t>(std::min<std::uint64_t>(place - begin_, part_.size()));
    const std::size_t kept = part_.size() - behind;
    bytes_.resize(held);
    std::copy(part_.begin() + static_cast<std::ptrdiff_t>(behind), part_.end(), bytes_.begin());
    std::size_t filled = kept;
    begin_ += behind;
    while (filled < place - begin_ + count) {
      const std::size_t read = file_->read(bytes_.data() + filled, bytes_.size() - filled);
      if (read == 0) throw InputError(file_->path(), 0, 0, "a file that nothing writes to", "one that shrinks");
      filled += read;
    }
    part_ = {bytes_.data(), filled};
  }

  std::optional<detail::TextFile> file_;
  std::vector<char> bytes_;
  std::string_view part_;
  std::uint64_t begin_ = 0;  ///< of the part, in the file
  std::uint64_t size_;
};

}  // namespace pinnquad::logs
