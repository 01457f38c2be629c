// SPDX-License-Identifier: MIT
// Files that a command reads and writes: an output never takes the place of an input or of another output.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace programs {

/// Collects the files of a command before one of them is opened. Two paths are the same file if they lead to the same
/// place (relative or absolute, through links) or to the same content (hard links).
/// Both functions throw std::invalid_argument, one line, and take an empty path for an option that was not given.
class FileRoles {
 public:
  void reads(const std::string& option, const std::string& path) { add({option, path, false}); }
  void writes(const std::string& option, const std::string& path) { add({option, path, true}); }

 private:
  struct Role {
    std::string option, path;
    bool written;
  };

  void add(const Role& role) {
    if (role.path.empty()) return;
    if (role.written && is_standard_output(role.path)) {
      throw std::invalid_argument(role.option + " " + role.path + " is where standard output goes");
    }
    for (const Role& other : roles_) {
      if (!role.written && !other.written) continue;
      const Role &output = role.written ? role : other, &input = role.written ? other : role;
      if (!is_same(role.path, other.path) && !is_partial_of(input.path, output.path)) continue;
      throw std::invalid_argument(input.option + " " + input.path + " and " + output.option + " " + output.path +
                                  " are the same file; it would be overwritten");
    }
    roles_.push_back(role);
  }

  /// Where a path leads, with or without a file there.
  static std::filesystem::path place(const std::string& path) {
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(path, error);
    std::filesystem::path canonical = std::filesystem::weakly_canonical(absolute, error);
    if (error) canonical = absolute.lexically_normal();
    return canonical.has_filename() ? canonical : canonical.parent_path();
  }

  static bool is_same(const std::string& a, const std::string& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error) || place(a) == place(b);
  }

  /// An output is first written into a file of such a name (AtomicFile).
  static bool is_partial_of(const std::string& input, const std::string& output) {
    const std::string partial = place(output).string() + ".partial-";
    return place(input).string().compare(0, partial.size(), partial) == 0;
  }

  /// A file that the caller's shell has opened for what is printed (a terminal or a device is no file).
  static bool is_standard_output(const std::string& path) {
    struct stat file {};
    struct stat stream {};
    return ::stat(path.c_str(), &file) == 0 && ::fstat(STDOUT_FILENO, &stream) == 0 && S_ISREG(stream.st_mode) &&
           file.st_dev == stream.st_dev && file.st_ino == stream.st_ino;
  }

  std::vector<Role> roles_;
};

}  // namespace programs
