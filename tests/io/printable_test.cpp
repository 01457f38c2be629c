// SPDX-License-Identifier: MIT
#include "pinnquad/io/file_error.hpp"

#include <doctest/doctest.h>

#include <string>

using pinnquad::printable;

TEST_CASE("well-formed UTF-8 stays as it is") {
  for (const char* text : {"", "flight 1.csv",
                           "Flug \xc3\xbc"
                           "ber M\xc3\xbcnchen.csv",
                           "\xe9\xa3\x9b\xe8\xa1\x8c", "\xf0\x9f\x9a\x81",
                           "\\ \" */ ?"
                           "?/ %s"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("what is no UTF-8 becomes a question mark, byte by byte") {
  CHECK(printable("a\xff"
                  "b") == "a?b");
  CHECK(printable("\xc3") == "?");                 // cut off
  CHECK(printable("\xe9\xa3") == "??");            // cut off
  CHECK(printable("\xc3(") == "?(");               // no continuation
  CHECK(printable("\xc0\xaf") == "??");            // overlong '/'
  CHECK(printable("\xe0\x80\xaf") == "???");       // overlong
  CHECK(printable("\xed\xa0\x80") == "???");       // surrogate
  CHECK(printable("\xf4\x90\x80\x80") == "????");  // beyond U+10FFFF
  CHECK(printable("\xf5\x80\x80\x80") == "????");
  CHECK(printable("\x80") == "?");
}

TEST_CASE("nothing ends the line, steers a terminal or turns the direction of writing") {
  CHECK(printable("a\nb\rc\td") == "a?b?c?d");
  CHECK(printable(std::string("a\0b", 3)) == "a?b");
  CHECK(printable("\x1b[31mred") == "?[31mred");
  CHECK(printable("\x7f") == "?");
  CHECK(printable("\xc2\x85") == "?");      // next line
  CHECK(printable("\xe2\x80\xa8") == "?");  // line separator
  CHECK(printable("x\xe2\x80\xae"
                  "cba") == "x?cba");                          // right-to-left override
  CHECK(printable("\xe2\x81\xa6") == "?");                     // isolate
  CHECK(printable("\xd8\x9c") == "?");                         // Arabic letter mark
  CHECK(printable("\xd8\x9b\xd8\x9d") == "\xd8\x9b\xd8\x9d");  // its neighbours are letters as any
  CHECK(printable("\xe2\x80\xa6") == "\xe2\x80\xa6");          // an ellipsis is a letter as any
}

TEST_CASE("a message about a file is one line whatever the file is called") {
  const pinnquad::InputError read("a\nb\xff.csv", 3, 4, "x", "y");
  CHECK(std::string(read.what()) == "a?b?.csv:3:4: expected x, found y");
  CHECK(read.path == "a\nb\xff.csv");
  CHECK(std::string(pinnquad::OutputError("a\nb", "reason").what()) == "cannot write a?b: reason");
}
