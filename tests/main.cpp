// SPDX-License-Identifier: MIT
//
// The one translation unit that implements doctest, shared by the test program of every room.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
