# SPDX-License-Identifier: MIT
#
# Runs the lint over planted faults. Every line "// FAULT <text>" of a planted header must be answered by a message
# of the lint that starts with that header and holds that text.
cmake_minimum_required(VERSION 3.22)

execute_process(COMMAND "${CMAKE_COMMAND}" "-DINCLUDE_DIR=${INCLUDE_DIR}" -DLONGEST=14 -P "${LINT}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(code EQUAL 0)
  message(FATAL_ERROR "the lint passed the planted faults")
endif()
string(REPLACE ";" "," messages "${output}") # a list of lines, split nowhere else
string(REPLACE "\n" ";" messages "${messages}")

set(planted 0)
set(missed 0)
file(GLOB_RECURSE headers RELATIVE "${INCLUDE_DIR}" "${INCLUDE_DIR}/*.hpp")
foreach(header IN LISTS headers)
  file(STRINGS "${INCLUDE_DIR}/${header}" expectations REGEX "^// FAULT ")
  foreach(expectation IN LISTS expectations)
    string(REGEX REPLACE "^// FAULT " "" expectation "${expectation}")
    math(EXPR planted "${planted} + 1")
    set(found FALSE)
    foreach(line IN LISTS messages)
      string(FIND "${line}" "${header}" at_header)
      string(FIND "${line}" "${expectation}" at_text)
      if(at_header EQUAL 0 AND at_text GREATER -1)
        set(found TRUE)
      endif()
    endforeach()
    if(NOT found)
      message("missed in ${header}: ${expectation}")
      math(EXPR missed "${missed} + 1")
    endif()
  endforeach()
endforeach()

if(planted EQUAL 0)
  message(FATAL_ERROR "no fault is planted below ${INCLUDE_DIR}")
endif()
if(NOT output MATCHES "(^|\n[^0-9]*)${planted} faults in ")
  message("the lint reported another number of faults than the ${planted} planted")
  math(EXPR missed "${missed} + 1")
endif()
if(missed GREATER 0)
  message("The lint said:\n${output}")
  message(FATAL_ERROR "the lint is not to be trusted")
endif()
message(STATUS "all ${planted} planted faults found")
