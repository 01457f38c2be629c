// SPDX-License-Identifier: MIT
// A folder of results that one program works in at a time.
#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "command_line/folders.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {

/// Holds a folder; the lock (flock on the folder itself) ends with the program, however that ends.
class FolderLock {
 public:
  /// Makes the folder if it is not there. Throws OutputError, one line: it cannot be, or another program has it.
  explicit FolderLock(const std::string& path) : path_(path) {
    std::error_code ignored;
    made_ = !std::filesystem::exists(path, ignored);
    make_folders(path);
    lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) throw pinnquad::OutputError(path, pinnquad::system_reason(errno, "it does not open"));
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    const int reason = errno;
    if (reason != EWOULDBLOCK) return;  // a file system without locks
    ::close(lock_);
    throw pinnquad::OutputError(path, "another program is at work in it");
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// A folder that it made and that nothing came into goes again.
  ~FolderLock() {
    if (made_) ::rmdir(path_.c_str());
    ::close(lock_);
  }

 private:
  std::string path_;
  bool made_ = false;
  int lock_;
};

}  // namespace programs
