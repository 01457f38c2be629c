// SPDX-License-Identifier: MIT
// An output file that appears whole or not at all: written aside, put in its place by commit().
// Created at once, so that an unwritable folder is found before the work that fills the file.
#pragma once

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pinnquad/core/body.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

/// Writes `path.partial-N` in the folder of `path` and renames it to `path` on commit(). A file that was there stays as
/// it was until then. Without commit() (an exception, an early return) the destructor removes the partial file. A lock
/// (flock) that ends with its writer, however that ends, holds it: one that a killed program left is taken up again by
/// the next writer of that path, one of a living writer is left alone.
/// A link is followed: its target is replaced. Whole after a crash of the program, not after a loss of power (no sync).
/// Throws OutputError, one line: folder missing or not writable, a folder, a device, a write-protected file, disk full.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  ~AtomicFile() { discard(); }

  /// Takes away a partial file of that name if its writer is gone.
  static void remove_abandoned(const std::string& name) noexcept;

  /// Where to write; binary, so line ends stay as written. Write errors are kept and reported by commit().
  std::ostream& stream() noexcept { return stream_; }

  /// Flushes, closes and checks: all is written, and what is left to do is to put the file in its place.
  void close();

  /// close(), then puts the file in its place. To be called once. Of several files that belong together close() all
  /// before the first commit().
  void commit();

 private:
  static constexpr int existing = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;

  /// The file to replace: the path itself, or what a link points to.
  static std::filesystem::path resolve(const std::string& path);

  /// A file that nobody may write stays as it is, though its folder would let it be replaced, and root may do anything.
  static void require_writable(const std::string& path, const std::filesystem::file_status& status);

  /// Creates an empty `target.partial-N`, or empties one that nobody holds. 0, or why there is none (errno).
  int claim();

  /// 0, EEXIST if that name is taken, or another errno.
  int claim_name(const char* name) noexcept;

  static bool is_same(int lock, const struct stat& there) noexcept;

  /// A file of one name: what has others is somebody's.
  static bool is_ours(int lock, const char* name) noexcept;

  [[noreturn]] void refuse(int reason, const char* otherwise);

  /// Removes the partial file, if there still is one.
  void discard() noexcept;

  void release() noexcept;

  std::string path_;
  std::filesystem::path target_;
  std::string partial_;  ///< its name; empty before it is there and after it has left
  int lock_ = -1;
  std::ofstream stream_;
  bool closed_ = false;
};

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/io/impl/atomic_file.hpp"
#endif
