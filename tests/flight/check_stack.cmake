# SPDX-License-Identifier: MIT
#
# Compiles SOURCE with FLAGS as firmware would and lists the stack of each function; rejects a function whose stack the
# compiler cannot tell (alloca, arrays of run-time size) and one above LIMIT bytes.
cmake_minimum_required(VERSION 3.22)

separate_arguments(flags NATIVE_COMMAND "${FLAGS}")
get_filename_component(folder "${OBJECT}" DIRECTORY)
get_filename_component(name "${OBJECT}" NAME_WLE)
execute_process(
  COMMAND "${COMPILER}" -std=c++17 ${flags} -DNDEBUG -fno-exceptions -fno-rtti -fstack-usage
    "-I${INCLUDE_DIR}" -isystem "${EIGEN_INCLUDE_DIR}" -c "${SOURCE}" -o "${OBJECT}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${SOURCE} does not compile as flight code (${FLAGS})\n${output}")
endif()

# <file>:<line>:<column>:<function> TAB <bytes> TAB <static | dynamic | dynamic,bounded>
file(STRINGS "${folder}/${name}.su" lines)
set(rejected 0)
set(entries 0)
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^[^\t]*:([^\t]*)\t([0-9]+)\t([a-z,]+)$")
    message(FATAL_ERROR "${name}.su: not a line of -fstack-usage: ${line}")
  endif()
  set(function "${CMAKE_MATCH_1}")
  set(bytes "${CMAKE_MATCH_2}")
  set(kind "${CMAKE_MATCH_3}")
  if(function MATCHES "pinnquad_flight_")
    math(EXPR entries "${entries} + 1")
    string(REGEX REPLACE "\\(.*" "" shown "${function}")
    message("${bytes} B ${shown}")
  endif()
  if(NOT kind STREQUAL "static" AND NOT kind STREQUAL "dynamic,bounded")
    message("rejected: ${kind} stack: ${function}")
    math(EXPR rejected "${rejected} + 1")
  elseif(bytes GREATER LIMIT)
    message("rejected: ${bytes} B of stack, more than ${LIMIT}: ${function}")
    math(EXPR rejected "${rejected} + 1")
  endif()
endforeach()
if(entries EQUAL 0)
  message(FATAL_ERROR "${SOURCE} defines no function pinnquad_flight_...: nothing would be looked at")
endif()
if(rejected GREATER 0)
  message(FATAL_ERROR "${SOURCE} (${FLAGS}) has functions whose stack is not bounded as it should be")
endif()
