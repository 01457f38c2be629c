// SPDX-License-Identifier: MIT
// Text files read in blocks: as a whole, or record by record, so that a file larger than the memory can be read.
// What cannot be read is refused in one line.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/io/csv_cells.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/regular_file.hpp"

namespace pinnquad {
namespace detail {

/// A regular file open for reading. Throws InputError: no such file, a folder, a device, a pipe, too many bytes; from read():
/// an error of the device.
class TextFile {
 public:
  explicit TextFile(const std::string& path) : path_(path) {
    require_regular_file(path);
    errno = 0;
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) throw InputError(path, 0, 0, expected, "none (" + system_reason(errno, "it does not open") + ")");
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // it is read in blocks
  }

  /// Up to `size` bytes; 0 at the end.
  std::size_t read(char* into, std::size_t size) {
    const std::size_t count = std::fread(into, 1, size, file_.get());
    if (std::ferror(file_.get())) {
      throw InputError(path_, 0, 0, expected, "a read error (" + system_reason(errno, "reason unknown") + ")");
    }
    read_ += count;
    if (read_ > most_input_bytes) refuse_size(path_);  // it grows while it is read
    return count;
  }
  const std::string& path() const noexcept { return path_; }
  std::uintmax_t bytes_read() const noexcept { return read_; }

 private:
  static constexpr const char* expected = "a readable file";
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::uintmax_t read_ = 0;
};

inline constexpr std::size_t read_block = std::size_t{1} << 18;

}  // namespace detail

/// The whole of a file. Throws InputError, one line: no such file, a folder, a device, a pipe, a read error.
inline std::string file_text(const std::string& path) {
  detail::TextFile file(path);
  std::string text;
  std::vector<char> block(detail::read_block);
  while (const std::size_t count = file.read(block.data(), block.size())) text.append(block.data(), count);
  return text;
}

namespace detail {

/// Records of so many cells that a file holds at most: no more than its lines, and a record has a digit and a separator per
/// cell.
inline std::size_t most_records(const std::string& path, std::size_t cells) {
  TextFile file(path);
  std::size_t bytes = 0, ends = 0;
  std::vector<char> block(read_block);
  while (const std::size_t count = file.read(block.data(), block.size())) {
    bytes += count;
    ends +=
        static_cast<std::size_t>(std::count(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count), '\n'));
  }
  return std::min(ends, bytes / (2 * cells)) + 1;
}

/// The records of a comma-separated file, one after the other: a line each, or more where a quoted cell holds line ends.
/// A byte order mark is skipped. No more of the file is held than a block and a record.
class CsvRecords {
 public:
  explicit CsvRecords(const std::string& path) : file_(path), buffer_(read_block) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    fill();
    if (unread().substr(0, byte_order_mark.size()) == byte_order_mark) begin_ += byte_order_mark.size();
  }

  /// The next record without its line end, LF or CRLF; valid until the next call. False at the end of the file.
  /// Throws InputError: a quoted cell without end, a record of more than 16 MiB, a read error.
  bool next(std::string_view& record) {
    line_ = next_line_;
    QuotationState quotation;
    std::size_t searched = 0, followed = 0;  // from begin_
    has_quotes_ = false;
    for (;;) {
      std::string_view text = unread();
      std::size_t end = text.find('\n', searched);
      if (end == std::string_view::npos) {
        searched = text.size();
        if (fill()) continue;
        if (searched == 0) return false;
        text = unread();  // it has been moved
        end = text.size();
      }
      ++next_line_;
      if (has_quotes_ || text.substr(followed, end - followed).find('"') != std::string_view::npos) {
        has_quotes_ = true;
        quotation.follow(text.substr(followed, end - followed));
        followed = end;
        if (quotation.inside()) {
          if (end == text.size()) {
            throw InputError(file_.path(), line_, 0, "a closing quotation mark", "the end of the file");
          }
          searched = end + 1;
          continue;
        }
      }
      begin_ += end < text.size() ? end + 1 : end;
      record = text.substr(0, end);
      if (!record.empty() && record.back() == '\r') record.remove_suffix(1);
      return true;
    }
  }

  /// Where the last record begins, from 1.
  std::size_t line() const noexcept { return line_; }
  /// Bytes of the file up to the last record's end.
  std::uintmax_t bytes() const noexcept { return file_.bytes_read() - (end_ - begin_); }
  /// Whether there are quotation marks in the last record.
  bool has_quotes() const noexcept { return has_quotes_; }

 private:
  std::string_view unread() const noexcept { return {buffer_.data() + begin_, end_ - begin_}; }

  /// Puts what is unread to the front of the buffer and more behind it; false at the end of the file.
  bool fill() {
    constexpr std::size_t longest_record = std::size_t{1} << 24;
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ > longest_record) throw InputError(file_.path(), line_, 0, "a record of at most 16 MiB", "a longer one");
    if (buffer_.size() < end_ + read_block) buffer_.resize(2 * buffer_.size());
    const std::size_t count = file_.read(buffer_.data() + end_, read_block);
    end_ += count;
    return count > 0;
  }

  TextFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::size_t line_ = 1, next_line_ = 1;
  bool has_quotes_ = false;
};

}  // namespace detail
}  // namespace pinnquad
