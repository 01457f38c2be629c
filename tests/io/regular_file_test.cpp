// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <pinnquad/io/csv_table.hpp>
#include <string>

#include "support/temporary_folder.hpp"

using pinnquad::InputError;
using pinnquad_test::TemporaryFolder;

TEST_CASE("what may never end is refused instead of read") {
  const TemporaryFolder folder;
  const auto refused = [](const std::string& path, const std::string& why) {
    const std::string line = path + ": expected " + why;
    CHECK_THROWS_WITH_AS(pinnquad::read_csv(path, {"a"}), line.c_str(), InputError);
  };
  const std::string pipe = folder.path("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  refused(pipe, "a regular file, found a device or a pipe");
  refused("/dev/zero", "a regular file, found a device or a pipe");
  refused(folder.path(), "a readable file, found a folder");
  refused(folder.path("absent"), "a readable file, found none (No such file or directory)");
  std::filesystem::create_symlink("/dev/zero", folder.path("link.csv"));
  refused(folder.path("link.csv"), "a regular file, found a device or a pipe");
  const std::string large = folder.write("large.csv", "a\n1\n");
  std::filesystem::resize_file(large, pinnquad::detail::most_input_bytes + 1);  // a hole: it takes no space
  refused(large, "a file of at most 8 GiB, found a larger one");
}

TEST_CASE("links to regular files are read") {
  const TemporaryFolder folder;
  folder.write("in.csv", "a\n1\n");
  std::filesystem::create_symlink("in.csv", folder.path("link.csv"));
  CHECK(pinnquad::read_csv(folder.path("link.csv"), {"a"}).size() == 1);
}
