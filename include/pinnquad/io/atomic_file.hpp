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

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

namespace detail {

/// A partial file, held by a lock (flock) that ends with its writer, however that ends.
class PartialFile {
 public:
  PartialFile() = default;
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() { remove(); }

  /// Creates an empty `target.partial-N`, or empties one that nobody holds. 0, or why there is none (errno).
  int claim(const std::filesystem::path& target) {
    constexpr int most_names = 1000;  // writers at a time, and files that are not ours
    for (int number = 1; number <= most_names; ++number) {
      const std::string name = target.string() + ".partial-" + std::to_string(number);
      const int reason = claim_name(name.c_str());
      if (reason == 0) path_ = name;
      if (reason != EEXIST) return reason;
    }
    return EEXIST;
  }

  const std::filesystem::path& path() const noexcept { return path_; }

  /// Puts the file in its place: 0 or errno.
  int move_to(const std::filesystem::path& target) noexcept {
    if (std::rename(path_.c_str(), target.c_str()) != 0) return errno;
    path_.clear();
    release();
    return 0;
  }

  /// Takes the file away, if there still is one.
  void remove() noexcept {
    if (!path_.empty()) ::unlink(path_.c_str());
    path_.clear();
    release();
  }

  /// Takes away a partial file of that name if its writer is gone.
  static void remove_abandoned(const std::string& name) noexcept {
    PartialFile left_over;
    left_over.lock_ = ::open(name.c_str(), existing);
    if (left_over.lock_ < 0 || ::flock(left_over.lock_, LOCK_EX | LOCK_NB) != 0) return;
    if (left_over.is_ours(name.c_str())) ::unlink(name.c_str());
  }

 private:
  static constexpr int existing = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;

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
      if (::lstat(name, &there) != 0 || !is_same(there)) {  // put in place or removed before the lock was ours
        release();
        continue;
      }
      if (is_ours(name) && ::ftruncate(lock_, 0) == 0) return 0;
      release();
      return EEXIST;
    }
  }

  bool is_same(const struct stat& there) const noexcept {
    struct stat held {};
    return ::fstat(lock_, &held) == 0 && held.st_dev == there.st_dev && held.st_ino == there.st_ino;
  }

  /// A file of one name: what has others is somebody's.
  bool is_ours(const char* name) const noexcept {
    struct stat there {};
    return ::lstat(name, &there) == 0 && is_same(there) && S_ISREG(there.st_mode) && there.st_nlink == 1;
  }

  void release() noexcept {
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
  }

  std::filesystem::path path_;
  int lock_{-1};
};

}  // namespace detail

/// Writes `path.partial-N` in the folder of `path` and renames it to `path` on commit(). A file that was there stays as
/// it was until then. Without commit() (an exception, an early return) the destructor removes the partial file; one
/// that a killed program left is taken up again by the next writer of that path, one of a living writer is left alone.
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

  /// Takes away a partial file of that name if its writer is gone.
  static void remove_abandoned(const std::string& name) noexcept { detail::PartialFile::remove_abandoned(name); }

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
  detail::PartialFile partial_;
  std::ofstream stream_;
  bool closed_{false};
};

}  // namespace pinnquad
