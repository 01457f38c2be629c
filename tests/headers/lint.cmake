# SPDX-License-Identifier: MIT
#
# The rules of the house that a compiler does not check, over every header below INCLUDE_DIR/pinnquad:
#   - "#pragma once", the SPDX line, at most 400 lines
#   - imports point up the list of rooms, never down, never in a circle; no room includes an umbrella header
#   - core/types.hpp alone includes Eigen, but for its decompositions: regression/impl/ridge.hpp
#   - every header is reached from the umbrella pinnquad/pinnquad.hpp
#   - a room that flies includes only rooms that fly, no header of the standard library that allocates, throws, prints,
#     locks or keeps time, and has no word that throws, allocates, asserts or dispatches at run time
#
#   cmake -DINCLUDE_DIR=include -P tests/headers/lint.cmake
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/PinnquadRooms.cmake")

set(LONGEST 400)
set(grounded
  any chrono condition_variable deque exception filesystem forward_list fstream functional future iomanip ios iostream
  istream list locale map memory mutex new optional ostream queue random regex set shared_mutex sstream stack stdexcept
  streambuf string system_error thread typeindex typeinfo unordered_map unordered_set variant vector
  cassert assert.h cstdio stdio.h)
set(grounded_words throw try catch virtual dynamic_cast typeid assert new delete malloc free thread_local)

set(faults 0)
function(fault header message)
  message("${header}: ${message}")
  math(EXPR faults "${faults} + 1")
  set(faults ${faults} PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE headers RELATIVE "${INCLUDE_DIR}" "${INCLUDE_DIR}/pinnquad/*.hpp")
if(NOT headers)
  message(FATAL_ERROR "no headers below ${INCLUDE_DIR}/pinnquad")
endif()

foreach(header IN LISTS headers)
  file(READ "${INCLUDE_DIR}/${header}" text)

  # file-level rules
  if(NOT text MATCHES "(^|\n)#pragma once\n")
    fault("${header}" "no '#pragma once'")
  endif()
  if(NOT text MATCHES "(^|\n)// SPDX-License-Identifier: MIT\n")
    fault("${header}" "no line '// SPDX-License-Identifier: MIT'")
  endif()
  string(REGEX REPLACE "[^\n]" "" newlines "${text}")
  string(LENGTH "${newlines}" lines)
  if(lines GREATER LONGEST)
    fault("${header}" "${lines} lines; a header has at most ${LONGEST}")
  endif()

  # which room is this?
  set(room "")
  set(flies FALSE)
  if(header MATCHES "^pinnquad/([^/]+)/")
    set(room "${CMAKE_MATCH_1}")
    list(FIND PINNQUAD_ROOMS "${room}" place)
    if(place EQUAL -1)
      fault("${header}" "'${room}' is no room (cmake/PinnquadRooms.cmake lists them)")
      continue()
    endif()
    if(room IN_LIST PINNQUAD_FLIGHT_ROOMS)
      set(flies TRUE)
    endif()
  elseif(header MATCHES "^pinnquad/(flight|version)\\.hpp$")
    set(flies TRUE)
  endif()

  # includes
  file(STRINGS "${INCLUDE_DIR}/${header}" includes REGEX "^[ \t]*#[ \t]*include")
  set(own_includes "")
  foreach(include IN LISTS includes)
    if(NOT include MATCHES "include[ \t]*[<\"]([^>\"]+)[>\"]")
      fault("${header}" "an include that is not a plain name: ${include}")
      continue()
    endif()
    set(name "${CMAKE_MATCH_1}")

    if(name MATCHES "^Eigen/(Cholesky|Jacobi)$" AND header STREQUAL "pinnquad/regression/impl/ridge.hpp")
      continue()
    endif()
    if(name MATCHES "^(unsupported/)?Eigen/" AND NOT header STREQUAL "pinnquad/core/types.hpp")
      fault("${header}" "includes <${name}>; core/types.hpp alone includes Eigen")
    endif()
    if(flies AND name IN_LIST grounded)
      fault("${header}" "includes <${name}>, which does not fly")
    endif()

    if(name MATCHES "^pinnquad/")
      list(APPEND own_includes "${name}")
    endif()
    if(name MATCHES "^pinnquad/([^/]+)/")
      set(other "${CMAKE_MATCH_1}")
      list(FIND PINNQUAD_ROOMS "${other}" other_place)
      if(flies AND NOT other IN_LIST PINNQUAD_FLIGHT_ROOMS)
        fault("${header}" "includes <${name}>, a room that does not fly")
      elseif(room AND other_place GREATER place)
        fault("${header}" "includes <${name}>: imports point up the list of rooms, '${room}' comes before '${other}'")
      endif()
    elseif(room AND name MATCHES "^pinnquad/(flight|pinnquad)\\.hpp$")
      fault("${header}" "includes the umbrella <${name}>")
    elseif(name MATCHES "\\.hpp$" AND NOT name MATCHES "^pinnquad/")
      fault("${header}" "includes \"${name}\"; write <pinnquad/...>")
    endif()
  endforeach()
  set(includes_of_${header} "${own_includes}")

  # words
  if(flies)
    string(REGEX REPLACE "//[^\n]*" "" code "${text}")
    string(REGEX REPLACE "\"[^\"\n]*\"" "\"\"" code "${code}")
    string(REGEX REPLACE "#[ \t]*include[^\n]*" "" code "${code}")
    string(REGEX REPLACE "= *delete" "" code "${code}") # a deleted function
    foreach(word IN LISTS grounded_words)
      if(code MATCHES "(^|[^A-Za-z0-9_])${word}([^A-Za-z0-9_]|$)")
        fault("${header}" "says '${word}', which does not fly")
      endif()
    endforeach()
  endif()
endforeach()

# A circle is what is left when headers without includes are taken away again and again. A header's bodies (impl/) include it,
# and it them at its end.
set(left ${headers})
list(REMOVE_ITEM left "pinnquad/pinnquad.hpp") # no room includes it
set(progress TRUE)
while(progress)
  set(progress FALSE)
  foreach(header IN LISTS left)
    set(open FALSE)
    foreach(include IN LISTS includes_of_${header})
      if(include IN_LIST left AND NOT include MATCHES "/impl/")
        set(open TRUE)
      endif()
    endforeach()
    if(NOT open)
      list(REMOVE_ITEM left "${header}")
      set(progress TRUE)
    endif()
  endforeach()
endwhile()
if(left)
  list(JOIN left " " circle)
  fault("${circle}" "include each other in a circle (or include one that does)")
endif()

# Everything is what pinnquad.hpp says that it includes.
set(reached "")
set(open "pinnquad/pinnquad.hpp")
while(open)
  list(POP_FRONT open header)
  if(NOT header IN_LIST reached)
    list(APPEND reached "${header}")
    list(APPEND open ${includes_of_${header}})
  endif()
endwhile()
foreach(header IN LISTS headers)
  if(NOT header IN_LIST reached)
    fault("${header}" "is not reached from pinnquad/pinnquad.hpp")
  endif()
endforeach()

list(LENGTH headers count)
if(faults GREATER 0)
  message(FATAL_ERROR "${faults} faults in ${count} headers")
endif()
message(STATUS "${count} headers, no fault")
