// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <pinnquad/io/atomic_file.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

using pinnquad::AtomicFile;
using pinnquad::OutputError;
using pinnquad_test::TemporaryFolder;
using Names = std::vector<std::string>;

namespace {

/// A disk that fills up after `bytes`: the system refuses to let any file grow beyond, also for root.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_limit_);
    rlimit limit = old_limit_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_limit_{};
  void (*old_handler_)(int);
};

}  // namespace

TEST_CASE("a file appears at commit, whole, and nothing else stays") {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder.path("out.txt"));
    file.stream() << "line\r\n" << 42 << '\n';
    CHECK(folder.listing() == Names{"out.txt.partial-1"});
    file.commit();
    CHECK(folder.listing() == Names{"out.txt"});
  }
  CHECK(folder.listing() == Names{"out.txt"});
  CHECK(folder.read("out.txt") == "line\r\n42\n");
}

TEST_CASE("without commit the old file stays as it was, and the folder too") {
  const TemporaryFolder folder;
  folder.write("out.txt", "old");
  SUBCASE("early return") {
    AtomicFile file(folder.path("out.txt"));
    file.stream() << "half of it" << std::flush;
  }
  SUBCASE("exception") {
    try {
      AtomicFile file(folder.path("out.txt"));
      file.stream().exceptions(std::ios::badbit);
      file.stream() << "half of it" << std::flush;
      throw std::runtime_error("interrupted");
    } catch (const std::runtime_error&) {
    }
  }
  CHECK(folder.listing() == Names{"out.txt"});
  CHECK(folder.read("out.txt") == "old");
}

TEST_CASE("commit replaces a file; two writers do not meet") {
  const TemporaryFolder folder;
  folder.write("out.txt", "old and longer than the new one");
  AtomicFile first(folder.path("out.txt"));
  AtomicFile second(folder.path("out.txt"));
  CHECK(folder.listing() == Names{"out.txt", "out.txt.partial-1", "out.txt.partial-2"});
  first.stream() << "first";
  second.stream() << "second";
  first.commit();
  CHECK(folder.read("out.txt") == "first");
  AtomicFile third(folder.path("out.txt"));
  second.commit();
  CHECK(folder.read("out.txt") == "second");
  CHECK(folder.listing() == Names{"out.txt", "out.txt.partial-1"});
  third.stream() << "third";
  third.commit();
  CHECK(folder.read("out.txt") == "third");
  CHECK(folder.listing() == Names{"out.txt"});
}

TEST_CASE("what killed writers leave does not pile up, and what a living one has is not taken") {
  const TemporaryFolder folder;
  const auto killed = [&folder] {  // a writer that dies in the middle of its file
    const pid_t child = fork();
    if (child == 0) {
      AtomicFile file(folder.path("out.txt"));
      file.stream() << "left over, and longer than what comes" << std::flush;
      std::raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
  };
  AtomicFile living(folder.path("out.txt"));
  living.stream() << "living" << std::flush;
  for (int i = 0; i < 3; ++i) REQUIRE(killed());
  CHECK(folder.listing() == Names{"out.txt.partial-1", "out.txt.partial-2"});
  AtomicFile next(folder.path("out.txt"));
  next.stream() << "next";
  next.commit();
  CHECK(folder.read("out.txt") == "next");
  living.commit();
  CHECK(folder.read("out.txt") == "living");
  CHECK(folder.listing() == Names{"out.txt"});

  REQUIRE(killed());
  AtomicFile::remove_abandoned(folder.path("out.txt.partial-1"));
  CHECK(folder.listing() == Names{"out.txt"});
  const AtomicFile held(folder.path("out.txt"));
  AtomicFile::remove_abandoned(folder.path("out.txt.partial-1"));
  CHECK(folder.listing() == Names{"out.txt", "out.txt.partial-1"});
}

TEST_CASE("files of partial names that no writer left are neither read, emptied nor removed") {
  const TemporaryFolder folder;
  folder.write("other", "of somebody");
  std::filesystem::create_directory(folder.path("out.txt.partial-1"));
  std::filesystem::create_symlink("other", folder.path("out.txt.partial-2"));
  std::filesystem::create_symlink("nowhere", folder.path("out.txt.partial-3"));
  std::filesystem::create_hard_link(folder.path("other"), folder.path("out.txt.partial-4"));
  const Names before = folder.listing();
  AtomicFile file(folder.path("out.txt"));
  file.stream() << "text";
  file.commit();
  for (const std::string& name : before) {
    if (name != "other") AtomicFile::remove_abandoned(folder.path(name));
  }
  CHECK(folder.read("out.txt") == "text");
  CHECK(folder.read("other") == "of somebody");
  Names expected = before;
  expected.insert(expected.begin() + 1, "out.txt");
  CHECK(folder.listing() == expected);
}

TEST_CASE("of files that belong together none appears where one cannot be written") {
  const TemporaryFolder folder;
  AtomicFile first(folder.path("a.txt")), second(folder.path("b.txt"));
  first.stream() << "first";
  second.stream() << std::string(500, 'x');
  const auto put_in_place = [&] {
    const FullDisk disk(100);
    for (AtomicFile* file : {&first, &second}) file->close();
    for (AtomicFile* file : {&first, &second}) file->commit();
  };
  CHECK_THROWS_AS(put_in_place(), OutputError);
  CHECK(folder.listing() == Names{"a.txt.partial-1"});
  first.commit();  // closed and whole
  CHECK(folder.read("a.txt") == "first");
}

TEST_CASE("a link stays a link; the file it names is replaced") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("real"));
  folder.write("real/out.txt", "old");
  std::filesystem::create_symlink("real/out.txt", folder.path("link.txt"));
  AtomicFile file(folder.path("link.txt"));
  file.stream() << "new";
  file.commit();
  CHECK(std::filesystem::is_symlink(folder.path("link.txt")));
  CHECK(folder.read("real/out.txt") == "new");

  std::filesystem::create_symlink("nowhere", folder.path("broken.txt"));
  const std::string path = folder.path("broken.txt");
  CHECK_THROWS_WITH_AS(AtomicFile{path}, ("cannot write " + path + ": it is a link to nowhere").c_str(), OutputError);
}

TEST_CASE("what cannot be written is said before the work, in one line") {
  const TemporaryFolder folder;
  folder.write("file", "");
  const auto refused = [&folder](const std::string& name, const std::string& reason) {
    const std::string path = folder.path(name);
    CHECK_THROWS_WITH_AS(AtomicFile{path}, ("cannot write " + path + ": " + reason).c_str(), OutputError);
  };
  refused("missing/out.txt", "No such file or directory");
  refused("file/out.txt", "Not a directory");
  refused(".", "it is a folder");
  // whoever asks, and through a link
  std::filesystem::permissions(folder.path("file"), std::filesystem::perms::owner_read);
  refused("file", "it is write-protected");
  std::filesystem::create_symlink("file", folder.path("link"));
  refused("link", "it is write-protected");
  std::filesystem::remove(folder.path("link"));
  CHECK(folder.listing() == Names{"file"});
  CHECK_THROWS_WITH_AS(AtomicFile{"/dev/null"}, "cannot write /dev/null: it is not a regular file", OutputError);
}

TEST_CASE("a disk that fills up is noticed, and the old file survives") {
  const TemporaryFolder folder;
  folder.write("out.txt", "old");
  const std::string path = folder.path("out.txt");
  const std::string line = "cannot write " + path + ": File too large";
  const auto write_bytes = [&path](std::size_t bytes) {
    AtomicFile file(path);
    file.stream() << std::string(bytes, 'x');
    const FullDisk disk(100);
    file.commit();
  };
  const auto write_flushed = [&path](std::size_t bytes) {
    AtomicFile file(path);
    const FullDisk disk(1000);
    file.stream() << std::string(bytes, 'x') << std::flush << "more";
    CHECK_FALSE(file.stream().good());
    file.commit();
  };
  CHECK_THROWS_WITH_AS(write_bytes(500), line.c_str(), OutputError);  // only the buffer's flush fails
  CHECK_THROWS_WITH_AS(write_flushed(200000), line.c_str(), OutputError);
  CHECK(folder.listing() == Names{"out.txt"});
  CHECK(folder.read("out.txt") == "old");
}

TEST_CASE("an error that a caller left in the stream fails the commit") {
  const TemporaryFolder folder;
  const std::string path = folder.path("out.txt");
  AtomicFile file(path);
  file.stream() << "text";
  file.stream().setstate(std::ios::failbit);
  CHECK_THROWS_WITH_AS(file.commit(), ("cannot write " + path + ": writing failed").c_str(), OutputError);
  CHECK(folder.listing().empty());
}
