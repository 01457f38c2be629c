// SPDX-License-Identifier: MIT
// The one line that a reader says of a file that it refuses.
#pragma once

#include <doctest/doctest.h>

#include <string>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad_test {

/// The line that `read()` refuses with, without `path` at its begin; "accepted".
template <class Read>
std::string complaint_of(const Read& read, const std::string& path = "") {
  try {
    read();
  } catch (const pinnquad::InputError& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);
    CHECK(what.substr(0, path.size()) == path);
    return what.substr(path.size());
  }
  return "accepted";
}

}  // namespace pinnquad_test
