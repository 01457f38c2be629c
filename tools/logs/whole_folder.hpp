// SPDX-License-Identifier: MIT
// A folder of results that appears whole or not at all.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {

/// A folder to write into, `target.partial-N`, which takes the target's place on commit(). Without commit() the
/// destructor removes it with all that is in it; one that a killed program left is taken up again by the next writer of
/// that target. The target keeps its contents until then; the caller says whether it may be replaced.
class WholeFolder {
 public:
  /// Throws OutputError, one line: nothing can be made beside the target.
  explicit WholeFolder(const std::string& target) : shown_(target) {
    std::filesystem::path path = target;
    if (!path.has_filename()) path = path.parent_path();  // "out/"
    std::error_code error;
    if (std::filesystem::is_symlink(std::filesystem::symlink_status(path, error))) {
      path = std::filesystem::canonical(path, error);
    } else {
      error.clear();
    }
    if (error) throw OutputError(shown_, "it is a link to nowhere");
    target_ = path;
    if (target_.has_parent_path()) std::filesystem::create_directories(target_.parent_path(), error);
    if (error) throw OutputError(target_.parent_path().string(), error.message());
    claim();
  }
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;
  ~WholeFolder() { discard(); }

  /// Where to write.
  const std::filesystem::path& path() const noexcept { return path_; }

  /// Puts the folder in its place; what stood there is removed. Throws OutputError if it does not get there.
  void commit() {
    std::error_code error;
    const bool replaces = std::filesystem::exists(target_, error);
    if (!replaces) {
      if (std::rename(path_.c_str(), target_.c_str()) != 0) refuse();
    } else if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0) {
      if (errno != EINVAL && errno != ENOSYS) refuse();
      const std::filesystem::path old = path_.string() + ".old";  // a file system that can't exchange
      if (std::rename(target_.c_str(), old.c_str()) != 0) refuse();
      if (std::rename(path_.c_str(), target_.c_str()) != 0) {
        const int reason = errno;
        static_cast<void>(std::rename(old.c_str(), target_.c_str()));
        errno = reason;
        refuse();
      }
      path_ = old;
    }
    if (replaces) std::filesystem::remove_all(path_, error);
    path_.clear();
    release();
  }

 private:
  [[noreturn]] void refuse() const { throw OutputError(shown_, system_reason(errno, "it does not get its name")); }

  void claim() {
    constexpr int most_names = 1000;
    for (int number = 1; number <= most_names; ++number) {
      const std::filesystem::path name = target_.string() + ".partial-" + std::to_string(number);
      if (::mkdir(name.c_str(), 0777) != 0 && errno != EEXIST) {
        throw OutputError(shown_, system_reason(errno, "no partial folder can be made"));
      }
      lock_ = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
      if (lock_ < 0) continue;
      if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {  // a living writer's
        release();
        continue;
      }
      path_ = name;
      std::error_code error;
      for (const auto& left_over : std::filesystem::directory_iterator(path_, error)) {
        std::filesystem::remove_all(left_over.path(), error);
      }
      return;
    }
    throw OutputError(shown_, "no partial folder can be made");
  }

  void discard() noexcept {
    std::error_code error;
    if (!path_.empty()) std::filesystem::remove_all(path_, error);
    path_.clear();
    release();
  }

  void release() noexcept {
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
  }

  std::string shown_;
  std::filesystem::path target_;
  std::filesystem::path path_;
  int lock_{-1};
};

}  // namespace pinnquad::logs
