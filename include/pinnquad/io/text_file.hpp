// SPDX-License-Identifier: MIT
// Text files read in blocks. A file that cannot be read is refused in one line. Only a regular file of a size that a
// program can take in is read: a pipe or a device may never end.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

namespace detail {

/// Most bytes of a file that is read: the longest flight that `fly` records has 4e9.
inline constexpr std::uintmax_t most_input_bytes = std::uintmax_t{1} << 33;

[[noreturn]] inline void refuse_size(const std::string& path) {
  throw InputError(path, 0, 0, "a file of at most " + std::to_string(most_input_bytes >> 30) + " GiB", "a larger one");
}

}  // namespace detail

/// Throws InputError, one line, for all that is there and is no regular file of such a size. An absent file passes:
/// opening it gives the system's reason.
void require_regular_file(const std::string& path);

namespace detail {

/// A regular file open for reading. Throws InputError: no such file, a folder, a device, a pipe, too many bytes; from
/// read(): an error of the device.
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
std::string file_text(const std::string& path);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/io/impl/text_file.hpp"
#endif
