// SPDX-License-Identifier: MIT
#include "pinnquad/deploy/identifier.hpp"

#include <doctest/doctest.h>

using pinnquad::is_identifier;

TEST_CASE("names of structs") {
  for (const char* name : {"MyQuadModel", "Model2", "my_model", "m", "TrainedQuadModel", "Class", "NULLish"}) {
    CAPTURE(name);
    CHECK(is_identifier(name));
  }
}

TEST_CASE("no name: other characters, keywords, what C++ and its macros have taken") {
  for (const char* name : {"",
                           "9lives",
                           "my-model",
                           "a b",
                           "a.b",
                           "M\xc3\xbc"
                           "ller",
                           "a;",
                           "class",
                           "struct",
                           "int",
                           "xor",
                           "co_await",
                           "char8_t",
                           "constinit",
                           "_x9",
                           "_Model",
                           "__model",
                           "my__model",
                           "NULL",
                           "EOF",
                           "NAN",
                           "INFINITY",
                           "M_PI",
                           "I",
                           "FLT_MAX",
                           "errno",
                           "assert",
                           "linux",
                           "unix",
                           "stdin",
                           "main",
                           "std",
                           "pinnquad",
                           "time",
                           "exp",
                           "y0"}) {
    CAPTURE(name);
    CHECK_FALSE(is_identifier(name));
  }
}
