# SPDX-License-Identifier: MIT
#
# Writes the header PRECOMPILED, which includes the whole library, and beside it what g++ and clang++ take instead.
cmake_minimum_required(VERSION 3.22)

include("${CMAKE_CURRENT_LIST_DIR}/command.cmake")
file(WRITE "${PRECOMPILED}" "#pragma once\n#include <pinnquad/pinnquad.hpp>\n")
execute_process(COMMAND ${command} -x c++-header "${PRECOMPILED}" -o "${PRECOMPILED}.gch"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${output}")
endif()
