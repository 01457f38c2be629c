// SPDX-License-Identifier: MIT
// A program's edge to its terminal: exit codes, one line for what goes wrong, and standard output that was not lost.
#pragma once

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "command_line/in_columns.hpp"
#include "command_line/interrupt.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/version.hpp"

namespace programs {

constexpr int exit_failed = 1;
constexpr int exit_bad_input = 2;
constexpr int exit_internal_fault = 70;  ///< as sysexits.h has it

/// "fly: what is wrong" on stderr: one line, whatever a path or an argument holds; a terminal gets it wrapped.
inline void complain(const char* program, const std::string& what) {
  const std::string line = std::string(program) + ": " + pinnquad::printable(what);
  std::fprintf(stderr, "%s\n", isatty(STDERR_FILENO) != 0 ? in_columns(line, 2).c_str() : line.c_str());
}

/// `what`, and behind it the help to read next, such as "pinnquad train --help", where it names no command itself.
inline std::string with_help(const std::string& what, const std::string& help) {
  for (const char* named : {"pinnquad ", "pinnquad-study ", "--help"}) {
    if (what.find(named) != std::string::npos) return what;
  }
  return what + "; see " + help;
}

/// "pinnquad train --help" of the program that was called and the command that was chosen: itself where none was.
inline std::string help_of(const std::string& called, const std::string& command) {
  return called + (command == called ? "" : " " + command) + " --help";
}

namespace detail {

/// Descriptors 0, 1 and 2 that the caller closed are taken, or the first files opened would get what is printed.
/// Writing to them fails, as it should.
inline void take_closed_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) static_cast<void>(::open("/dev/null", O_RDONLY));
  }
}

/// A refusal names something that the user can mend: a file, an argument, a thing that the system denies.
inline bool is_refusal(const std::exception& error) {
  return dynamic_cast<const pinnquad::InputError*>(&error) != nullptr ||
         dynamic_cast<const pinnquad::OutputError*>(&error) != nullptr ||
         dynamic_cast<const std::invalid_argument*>(&error) != nullptr ||
         dynamic_cast<const std::system_error*>(&error) != nullptr;
}

}  // namespace detail

/// Runs a program: `body()` gives its exit code; what it throws becomes one line. A refusal and the want of memory are
/// exit_bad_input. Any other exception is a fault of ours, and exit_internal_fault. Standard output that could not be
/// written (a full disk, a closed pipe: files are finished all the same) is told as a refusal is.
/// Lines begin with `program`, which the body may change: to the command that was chosen. A refusal ends with a command
/// to type next: its own, or that command's --help.
template <class Body>
int run_program(const std::string& program, const Body& body) {
  detail::take_closed_streams();
  std::signal(SIGPIPE, SIG_IGN);  // a reader who left is no reason to lose a training
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is a full disk: an error to report
  int code = exit_bad_input;
  const std::string called = program;
  const auto fault = [&code](const std::string& what) {
    complain("pinnquad " PINNQUAD_VERSION, "internal fault: " + what + "; please report it");
    code = exit_internal_fault;
  };
  try {
    code = body();
  } catch (const Interrupted& interrupt) {
    complain(program.c_str(), "interrupted; " + interrupt.kept);
    code = exit_interrupted;
  } catch (const std::bad_alloc&) {
    complain(program.c_str(), "out of memory");
  } catch (const std::exception& error) {
    if (detail::is_refusal(error)) {
      complain(program.c_str(), with_help(error.what(), help_of(called, program)));
    } else {
      fault(error.what());
    }
  } catch (...) {
    fault("an exception without a description");
  }
  errno = 0;
  const bool failed_before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) != 0 || failed_before) {
    const std::string reason = pinnquad::system_reason(errno, "it is closed or full");
    if (code == 0) complain(program.c_str(), pinnquad::OutputError("standard output", reason).what());
    if (code == 0) code = exit_bad_input;
  }
  return code;
}

}  // namespace programs
