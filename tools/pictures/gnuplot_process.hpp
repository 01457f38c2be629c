// SPDX-License-Identifier: MIT
// gnuplot as a process: a script goes in, a picture comes out, and nothing of it touches the disk on the way.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "command_line/interrupt.hpp"

extern char** environ;

namespace programs {
namespace detail {

/// Both ends of a pipe, closed at the end.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_read();
    close_write();
  }
  bool open() const { return ends_[0] >= 0; }
  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_read() { close_end(ends_[0]); }
  void close_write() { close_end(ends_[1]); }

 private:
  static void close_end(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
  std::array<int, 2> ends_{-1, -1};
};

/// Starts gnuplot between the two pipes. 0 or errno.
inline int start_gnuplot(const Pipe& script, const Pipe& picture, pid_t& process) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&files, script.read_end(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, picture.write_end(), STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::string name = "gnuplot", plain = "--default-settings";  // the user's gnuplotrc has no say
  char* const arguments[] = {name.data(), plain.data(), nullptr};
  const int reason = ::posix_spawnp(&process, name.c_str(), &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return reason;
}

/// Writes the script and reads the picture at the same time: either pipe may be full while gnuplot waits for the other.
inline std::string exchange(Pipe& script, Pipe& picture, const std::string& text) {
  ::fcntl(script.write_end(), F_SETFL, O_NONBLOCK);
  std::string drawn;
  std::array<char, 1 << 16> block;
  std::size_t sent = 0;
  for (;;) {
    if (sent == text.size()) script.close_write();
    std::array<pollfd, 2> ready = {{{picture.read_end(), POLLIN, 0}, {script.write_end(), POLLOUT, 0}}};
    if (::poll(ready.data(), ready.size(), -1) < 0) {
      if (errno == EINTR) continue;
      return drawn;
    }
    if (ready[1].revents != 0 && sent < text.size()) {
      const ssize_t count = ::write(script.write_end(), text.data() + sent, text.size() - sent);
      if (count > 0) sent += static_cast<std::size_t>(count);
      if (count < 0 && errno != EAGAIN && errno != EINTR) sent = text.size();  // gnuplot has ended: its code says why
    }
    if (ready[0].revents != 0) {
      const ssize_t count = ::read(picture.read_end(), block.data(), block.size());
      if (count == 0 || (count < 0 && errno != EINTR)) return drawn;
      if (count > 0) drawn.append(block.data(), static_cast<std::size_t>(count));
    }
  }
}

}  // namespace detail

/// The SVG that gnuplot draws from a script that sets an SVG terminal. Nothing, after one line on stderr, if gnuplot is
/// missing or fails, or if what it drew is not whole. Throws Interrupted where Ctrl-C ended it.
inline std::optional<std::string> run_gnuplot(const std::string& script_text) {
  detail::Pipe script, picture;
  pid_t process = 0;
  int code = -1;
  std::string drawn;
  if (script.open() && picture.open() && detail::start_gnuplot(script, picture, process) == 0) {
    script.close_read();
    picture.close_write();
    drawn = detail::exchange(script, picture, script_text);
    while (::waitpid(process, &code, 0) < 0 && errno == EINTR) {
    }
  }
  const std::string end = "</svg>";
  const std::size_t last = drawn.find_last_not_of(" \n");
  const bool whole =
      last != std::string::npos && last + 1 >= end.size() && drawn.compare(last + 1 - end.size(), end.size(), end) == 0;
  if (code == 0 && whole) return drawn;
  stop_if_interrupted();  // gnuplot gets the Ctrl-C too
  std::fprintf(stderr, "plots: gnuplot is missing or failed (Debian: gnuplot-nox)\n");
  return {};
}

}  // namespace programs
