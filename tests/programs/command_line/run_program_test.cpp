// SPDX-License-Identifier: MIT
// A program's answer to an exception: a refusal is its user's to mend, anything else is a fault of ours.
#include <doctest/doctest.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <variant>

#include <fcntl.h>
#include <unistd.h>

#include "command_line/console.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "command_line/progress_line.hpp"
#include "support/temporary_folder.hpp"

namespace {

struct Ended {
  int code;
  std::string said;
};

/// Runs a program that does as `body` does, and keeps its standard error.
template <class Body>
Ended ended(const Body& body) {
  const pinnquad_test::TemporaryFolder folder;
  const std::string path = folder.path("stderr.txt");
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600), terminal = ::dup(STDERR_FILENO);
  REQUIRE(file >= 0);
  ::dup2(file, STDERR_FILENO);
  const int code = programs::run_program("land", body);
  ::dup2(terminal, STDERR_FILENO);
  ::close(terminal);
  ::close(file);
  std::ifstream said(path);
  return {code, {std::istreambuf_iterator<char>(said), {}}};
}

template <class Error>
Ended ended_by(const Error& error) {
  return ended([&error]() -> int { throw error; });
}

void check_refused(const Ended& end, const std::string& what) {
  CHECK(end.code == 2);
  CHECK(end.said == "land: " + what + "; see land --help\n");
}

void check_fault(const Ended& end, const std::string& what) {
  CHECK(end.code == 70);
  CHECK(end.said == "pinnquad " PINNQUAD_VERSION ": internal fault: " + what + "; please report it\n");
}

}  // namespace

TEST_CASE("an exit code is handed on, and nothing is said") {
  for (const int code : {0, 1, 3, 130}) {
    const Ended end = ended([code] { return code; });
    CHECK(end.code == code);
    CHECK(end.said.empty());
  }
}

TEST_CASE("a refusal that names a command to type next is left as it is") {
  const std::string what = "--out is needed: pinnquad fly d1 --out d1.csv";
  CHECK(ended_by(std::invalid_argument(what)).said == "land: " + what + "\n");
  const std::string name = "pinnquad";
  CHECK(programs::help_of(name, "train") == "pinnquad train --help");
  CHECK(programs::help_of(name, name) == "pinnquad --help");
}

TEST_CASE("a refusal is one line of the command, exit code 2") {
  check_refused(ended_by(pinnquad::InputError("a.csv", 3, 0, "a number", "'x'")),
                "a.csv:3: expected a number, found 'x'");
  check_refused(ended_by(pinnquad::OutputError("a.csv", "the disk is full")), "cannot write a.csv: the disk is full");
  check_refused(ended_by(std::invalid_argument("--out is needed\nhere")), "--out is needed?here");
  const std::filesystem::filesystem_error denied("reading", std::make_error_code(std::errc::permission_denied));
  check_refused(ended_by(denied), denied.what());
  const Ended end = ended_by(std::bad_alloc());
  CHECK(end.code == 2);
  CHECK(end.said == "land: out of memory\n");
}

TEST_CASE("an interruption says what is kept, exit code 130") {
  const Ended end = ended([]() -> int { throw programs::Interrupted{"2 of 3 are kept"}; });
  CHECK(end.code == 130);
  CHECK(end.said == "land: interrupted; 2 of 3 are kept\n");
  CHECK(ended_by(programs::Interrupted{}).said == "land: interrupted; nothing was written\n");
}

TEST_CASE("Ctrl-C stops what reports its progress; of work side by side the finished is kept") {
  programs::catch_interrupt();
  programs::ProgressLine progress("landing");
  progress.update(0.1);
  std::atomic<int> finished{0};
  programs::run_parallel(
      "", 100, 2, [] { return 0.0; },
      [&](std::size_t i) {
        programs::stop_if_interrupted();
        finished.fetch_add(1);
        if (i == 10) std::raise(SIGINT);
        while (i > 10 && !programs::interrupted()) std::this_thread::yield();  // the other thread's are not all of them
      });
  CHECK(programs::interrupted());
  CHECK(finished >= 1);
  CHECK(finished < 100);
  CHECK_THROWS_AS(progress.update(0.2), programs::Interrupted);
  const Ended end = ended([&]() -> int {
    programs::keeping("ten landings are kept", [&] { progress.update(0.3); });
    return 0;
  });
  CHECK(end.code == 130);
  CHECK(end.said == "land: interrupted; ten landings are kept\n");
  programs::detail::interrupt_wanted.store(false);
  std::signal(SIGINT, SIG_DFL);
}

TEST_CASE("any other exception is a fault of the program, exit code 70") {
  check_fault(ended_by(std::logic_error("no model")), "no model");
  check_fault(ended_by(std::runtime_error("no solution")), "no solution");
  check_fault(ended_by(std::out_of_range("no row 7")), "no row 7");
  check_fault(ended([] { return std::optional<int>().value(); }), std::bad_optional_access().what());
  CHECK(ended([] { return std::get<int>(std::variant<int, char>('x')); }).code == 70);
  check_fault(ended_by(1), "an exception without a description");
}
