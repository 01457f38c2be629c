// SPDX-License-Identifier: MIT
// Bodies of atomic_file.hpp.
#pragma once

#include "pinnquad/io/atomic_file.hpp"

namespace pinnquad {

PINNQUAD_BODY AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(resolve(path)) {
  if (const int reason = claim()) throw OutputError(path_, system_reason(reason, "no partial file can be made"));
  errno = 0;
  stream_.open(partial_, std::ios::binary | std::ios::trunc);
  if (!stream_) refuse(errno, "the partial file does not open");
}

PINNQUAD_BODY void AtomicFile::remove_abandoned(const std::string& name) noexcept {
  const int lock = ::open(name.c_str(), existing);
  if (lock < 0) return;
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0 && is_ours(lock, name.c_str())) ::unlink(name.c_str());
  ::close(lock);
}

PINNQUAD_BODY void AtomicFile::close() {
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

PINNQUAD_BODY void AtomicFile::commit() {
  close();
  if (std::rename(partial_.c_str(), target_.c_str()) != 0) refuse(errno, "it does not get its name");
  partial_.clear();
  release();
}

PINNQUAD_BODY std::filesystem::path AtomicFile::resolve(const std::string& path) {
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

PINNQUAD_BODY void AtomicFile::require_writable(const std::string& path, const std::filesystem::file_status& status) {
  using std::filesystem::perms;
  constexpr perms to_write = perms::owner_write | perms::group_write | perms::others_write;
  if ((status.permissions() & to_write) == perms::none || ::access(path.c_str(), W_OK) != 0) {
    throw OutputError(path, "it is write-protected");
  }
}

PINNQUAD_BODY int AtomicFile::claim() {
  constexpr int most_names = 1000;  // writers at a time, and files that are not ours
  for (int number = 1; number <= most_names; ++number) {
    std::string name = target_.string() + ".partial-" + std::to_string(number);
    const int reason = claim_name(name.c_str());
    if (reason == 0) partial_ = std::move(name);
    if (reason != EEXIST) return reason;
  }
  return EEXIST;
}

PINNQUAD_BODY int AtomicFile::claim_name(const char* name) noexcept {
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

PINNQUAD_BODY bool AtomicFile::is_same(int lock, const struct stat& there) noexcept {
  struct stat held {};
  return ::fstat(lock, &held) == 0 && held.st_dev == there.st_dev && held.st_ino == there.st_ino;
}

PINNQUAD_BODY bool AtomicFile::is_ours(int lock, const char* name) noexcept {
  struct stat there {};
  return ::lstat(name, &there) == 0 && is_same(lock, there) && S_ISREG(there.st_mode) && there.st_nlink == 1;
}

PINNQUAD_BODY void AtomicFile::refuse(int reason, const char* otherwise) {
  discard();
  throw OutputError(path_, system_reason(reason, otherwise));
}

PINNQUAD_BODY void AtomicFile::discard() noexcept {
  stream_.exceptions(std::ios::goodbit);
  stream_.close();
  if (!partial_.empty()) ::unlink(partial_.c_str());
  partial_.clear();
  release();
}

PINNQUAD_BODY void AtomicFile::release() noexcept {
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
}

}  // namespace pinnquad
