// SPDX-License-Identifier: MIT
// A file that never touches a disk, for readers that take a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "fuzz/fuzzing.hpp"

namespace pinnquad_test {

class MemoryFile {
 public:
  explicit MemoryFile(const std::string& content) : file_(memfd_create("file", 0)) {
    expect(file_ >= 0, "memory for a file");
    for (std::size_t done = 0; done < content.size();) {
      const ssize_t count = write(file_, content.data() + done, content.size() - done);
      expect(count > 0, "memory for a file");
      done += static_cast<std::size_t>(count);
    }
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace pinnquad_test
