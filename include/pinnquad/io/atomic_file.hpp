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
  explicit AtomicFile(const std::string& path) : path_(path), target_(resolve(path)) {
    if (const int reason = claim()) throw OutputError(path_, system_reason(reason, "no partial file can be made"));
    errno = 0;
    stream_.open(partial_, std::ios::binary | std::ios::trunc);
    if (!stream_) refuse(errno, "the partial file does not open");
  }

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  ~AtomicFile() { discard(); }

  /// Takes away a partial file of that name if its writer is gone.
  static void remove_abandoned(const std::string& name) noexcept {
    const int lock = ::open(name.c_str(), existing);
    if (lock < 0) return;
    if (::flock(lock, LOCK_EX | LOCK_NB) == 0 && is_ours(lock, name.c_str())) ::unlink(name.c_str());
    ::close(lock);
  }

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
    if (!written || !flushed || !closed_) refuse(flush_reason != 0 ? flush_reason : errno, "writing failed");
  }

  /// close(), then puts the file in its place. To be called once. Of several files that belong together close() all
  /// before the first commit().
  void commit() {
    close();
    if (std::rename(partial_.c_str(), target_.c_str()) != 0) refuse(errno, "it does not get its name");
    partial_.clear();
    release();
  }

 private:
  static constexpr int existing = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;

  /// The file to replace: the path itself, or what a link points to.
  static std::filesystem::path resolve(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) throw OutputError(path, "it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) throw OutputError(path, "it is not a regular file");
    if (fs::exists(status)) require_writable(path, status);
    if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
    const fs::path target = fs::canonical(path, error);
    if (error) throw OutputError(path, "it is a link to nowhere");
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

  /// Creates an empty `target.partial-N`, or empties one that nobody holds. 0, or why there is none (errno).
  int claim() {
    constexpr int most_names = 1000;  // writers at a time, and files that are not ours
    for (int number = 1; number <= most_names; ++number) {
      std::string name = target_.string() + ".partial-" + std::to_string(number);
      const int reason = claim_name(name.c_str());
      if (reason == 0) partial_ = std::move(name);
      if (reason != EEXIST) return reason;
    }
    return EEXIST;
  }

  /// 0, EEXIST if that name is taken, or another errno.
  int claim_name(const char* name) noexcept {
    for (;;) {
      constexpr mode_t mode = 0666;  // less what the user's umask takes
      lock_ = ::open(name, existing | O_CREAT | O_EXCL, mode);
      const bool created = lock_ >= 0;
      if (!created && errno != EEXIST) return errno;
      if (!created) lock_ = ::open(name, existing);
      if (lock_ < 0 && errno == ENOENT) continue;  // its writer has just finished
      if (lock_ < 0) return EEXIST;                // a link, a folder, another user's
      if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        if (created && errno != EWOULDBLOCK) return 0;  // a file system without locks
        release();
        return EEXIST;
      }
      struct stat there {};
      if (::lstat(name, &there) != 0 || !is_same(lock_, there)) {  // put in place or removed before the lock was ours
        release();
        continue;
      }
      if (is_ours(lock_, name) && ::ftruncate(lock_, 0) == 0) return 0;
      release();
      return EEXIST;
    }
  }

  static bool is_same(int lock, const struct stat& there) noexcept {
    struct stat held {};
    return ::fstat(lock, &held) == 0 && held.st_dev == there.st_dev && held.st_ino == there.st_ino;
  }

  /// A file of one name: what has others is somebody's.
  static bool is_ours(int lock, const char* name) noexcept {
    struct stat there {};
    return ::lstat(name, &there) == 0 && is_same(lock, there) && S_ISREG(there.st_mode) && there.st_nlink == 1;
  }

  [[noreturn]] void refuse(int reason, const char* otherwise) {
    discard();
    throw OutputError(path_, system_reason(reason, otherwise));
  }

  /// Removes the partial file, if there still is one.
  void discard() noexcept {
    stream_.exceptions(std::ios::goodbit);
    stream_.close();
    if (!partial_.empty()) ::unlink(partial_.c_str());
    partial_.clear();
    release();
  }

  void release() noexcept {
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
  }

  std::string path_;
  std::filesystem::path target_;
  std::string partial_;  ///< its name; empty before it is there and after it has left
  int lock_ = -1;
  std::ofstream stream_;
  bool closed_ = false;
};

}  // namespace pinnquad
