# SPDX-License-Identifier: MIT
#
# Compiles SOURCE with -D<DEFINE> (nothing when empty) and compares with EXPECT: success, or failure with an error
# message that matches the regular expression MATCH. Only error lines count: notes and source excerpts could quote the
# text of a rule that was not broken. PRECOMPILED (precompile.cmake) is included first.
cmake_minimum_required(VERSION 3.22)

# in two messages: CMake breaks the lines of an error, which is hard to match and to read
macro(verdict text)
  message("${SOURCE} [${DEFINE}] ${text}")
  message(FATAL_ERROR "compile test failed")
endmacro()

include("${CMAKE_CURRENT_LIST_DIR}/command.cmake")
list(APPEND command -fsyntax-only -include "${PRECOMPILED}" -Winvalid-pch)
if(NOT DEFINE STREQUAL "")
  list(APPEND command "-D${DEFINE}")
endif()
execute_process(COMMAND "${CMAKE_COMMAND}" -E env LC_ALL=C ${command} "${SOURCE}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)

if(EXPECT STREQUAL "success")
  if(NOT code EQUAL 0)
    message("${output}")
    verdict("must compile, but does not")
  endif()
  return()
endif()

if(code EQUAL 0)
  verdict("compiles, but must not")
endif()
string(REGEX MATCHALL "[^\n]*error:[^\n]*" errors "${output}")
if(NOT errors MATCHES "${MATCH}")
  message("${output}")
  verdict("fails to compile, as it must, but no error message matches: ${MATCH}")
endif()
