// SPDX-License-Identifier: MIT
#include "pinnquad/deploy/cpp_text.hpp"

#include <doctest/doctest.h>

using pinnquad::is_identifier;

TEST_CASE("names of structs") {
  for (const char* name : {"MyQuadModel", "Model2", "my_model", "m", "TrainedQuadModel", "Class", "NULLish", "eigen",
                           "EigenModel", "Model_t2", "t", "model_T", "Uint", "timer"}) {
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
                           "y0",
                           "Eigen",
                           "EIGEN_ARCH_i386",
                           "M_PIf",
                           "P_tmpdir",
                           "size_t",
                           "int32_t",
                           "my_model_t",
                           "tm",
                           "timespec",
                           "timeval",
                           "itimerspec",
                           "sigevent",
                           "lconv",
                           "va_list",
                           "uint",
                           "ulong",
                           "ushort",
                           "u_int",
                           "fd_set",
                           "random_data"}) {
    CAPTURE(name);
    CHECK_FALSE(is_identifier(name));
  }
}
