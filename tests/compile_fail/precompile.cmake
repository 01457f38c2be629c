# SPDX-License-Identifier: MIT
#
# Writes the header PRECOMPILED, which includes what flies, and beside it what g++ and clang++ take instead. The rest of the
# library is parsed by those who include it: g++ instantiates again, in each unit, what a precompiled header has used.
cmake_minimum_required(VERSION 3.22)

include("${CMAKE_CURRENT_LIST_DIR}/command.cmake")
if(COMPILER_ID MATCHES "Clang")
  list(APPEND command -fpch-instantiate-templates) # here, not in each unit
endif()
# Written aside and put in its place whole: another ctest of this folder may be compiling with it.
string(RANDOM LENGTH 12 own)
set(written "${PRECOMPILED}.${own}")
file(CONFIGURE OUTPUT "${PRECOMPILED}" CONTENT "#pragma once\n#include <pinnquad/flight.hpp>\n" @ONLY) # if it differs
execute_process(COMMAND ${command} -x c++-header "${PRECOMPILED}" -o "${written}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT code EQUAL 0)
  file(REMOVE "${written}")
  message(FATAL_ERROR "${output}")
endif()
file(RENAME "${written}" "${PRECOMPILED}.gch")
