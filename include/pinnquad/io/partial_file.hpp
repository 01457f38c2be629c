// SPDX-License-Identifier: MIT
// Where an output is written before it takes its place: `target.partial-N`, which one living writer holds.
// What a killed writer left over is taken up again, so that such files do not pile up.
#pragma once

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pinnquad {

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

}  // namespace pinnquad
