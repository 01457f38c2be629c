// SPDX-License-Identifier: MIT
// An output file that appears whole or not at all: written aside, put in its place by commit().
// Created at once, so that an unwritable folder is found before the work that fills the file.
#pragma once

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <system_error>

#include <unistd.h>

#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/partial_file.hpp"

namespace pinnquad {

/// Writes `path.partial-N` in the folder of `path` and renames it to `path` on commit(). A file that was there stays as
/// it was until then. Without commit() (an exception, an early return) the destructor removes the partial file; one that
/// a killed program left is taken up again by the next writer of that path, one of a living writer is left alone.
/// A link is followed: its target is replaced. Whole after a crash of the program, not after a loss of power (no sync).
/// Throws OutputError, one line: folder missing or not writable, a folder, a device, a write-protected file, disk full.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path) : path_(path), target_(resolve(path)) {
    if (const int reason = partial_.claim(target_)) {
      throw OutputError(path_, system_reason(reason, "no partial file can be made"));
    }
    errno = 0;
    stream_.open(partial_.path(), std::ios::binary | std::ios::trunc);
    if (!stream_) {
      const int reason = errno;
      discard();
      throw OutputError(path_, system_reason(reason, "the partial file does not open"));
    }
  }

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  ~AtomicFile() { discard(); }

  /// Where to write; binary, so line ends stay as written. Write errors are kept and reported by commit().
  std::ostream& stream() noexcept { return stream_; }

  /// Flushes, closes and checks: all is written, and what is left to do is to put the file in its place.
  void close() {
    if (closed_) return;
    stream_.exceptions(std::ios::goodbit);  // whatever the user set: this class reports in its own words
    const bool written = stream_.good();
    errno = 0;
    if (!written) {  // lost already; one more byte makes the system tell its reason again
      stream_.clear();
      stream_.put('\n');
    }
    stream_.flush();
    const int flush_reason = errno;
    const bool flushed = stream_.good();
    errno = 0;
    stream_.close();
    closed_ = stream_.good();
    if (!written || !flushed || !closed_) {
      const int reason = flush_reason != 0 ? flush_reason : errno;
      discard();
      throw OutputError(path_, system_reason(reason, "writing failed"));
    }
  }

  /// close(), then puts the file in its place. To be called once. Of several files that belong together close() all
  /// before the first commit().
  void commit() {
    close();
    if (const int reason = partial_.move_to(target_)) {
      discard();
      throw OutputError(path_, system_reason(reason, "it does not get its name"));
    }
  }

 private:
  /// The file to replace: the path itself, or what a link points to.
  static std::filesystem::path resolve(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) {
      throw OutputError(path, "it is a folder");
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      throw OutputError(path, "it is not a regular file");
    }
    if (fs::exists(status)) require_writable(path, status);
    if (!fs::is_symlink(fs::symlink_status(path, error))) {
      return path;
    }
    const fs::path target = fs::canonical(path, error);
    if (error) {
      throw OutputError(path, "it is a link to nowhere");
    }
    return target;
  }

  /// A file that nobody may write stays as it is, though its folder would let it be replaced, and root may do anything.
  static void require_writable(const std::string& path, const std::filesystem::file_status& status) {
    using std::filesystem::perms;
    constexpr perms to_write = perms::owner_write | perms::group_write | perms::others_write;
    if ((status.permissions() & to_write) == perms::none || ::access(path.c_str(), W_OK) != 0) {
      throw OutputError(path, "it is write-protected");
    }
  }

  /// Removes the partial file, if there still is one.
  void discard() noexcept {
    stream_.exceptions(std::ios::goodbit);
    stream_.close();
    partial_.remove();
  }

  std::string path_;
  std::filesystem::path target_;
  PartialFile partial_;
  std::ofstream stream_;
  bool closed_{false};
};

}  // namespace pinnquad
