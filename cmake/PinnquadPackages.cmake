# SPDX-License-Identifier: MIT
#
# pinnquad_require_package(<name> DEBIAN <package> NEEDED_FOR <what> [VERSION <least version>])
# find_package in config mode that, when it fails, says what to install instead of where it looked. The version is compared
# here: asked for 3.4, Eigen 5 calls itself incompatible, and Eigen 3.4 does so asked for a range.
macro(pinnquad_require_package name)
  cmake_parse_arguments(_require "" "VERSION;DEBIAN;NEEDED_FOR" "" ${ARGN})
  find_package(${name} QUIET NO_MODULE)
  set(_require_what "${name}")
  if(_require_VERSION)
    string(APPEND _require_what " ${_require_VERSION} or newer")
  endif()
  if(NOT ${name}_FOUND)
    message(FATAL_ERROR
      "pinnquad: ${_require_NEEDED_FOR} need(s) ${_require_what}, which was not found. "
      "On Debian or Ubuntu, as root: apt-get install ${_require_DEBIAN}")
  elseif(_require_VERSION AND ${name}_VERSION AND ${name}_VERSION VERSION_LESS _require_VERSION)
    message(FATAL_ERROR
      "pinnquad: ${_require_NEEDED_FOR} need(s) ${_require_what}; version ${${name}_VERSION} is too old, "
      "found in ${${name}_DIR}")
  endif()
endmacro()

# pinnquad_require_pytest(): sets PINNQUAD_TEST_PYTHON, the Python that has pytest; Debian's before another of the PATH.
macro(pinnquad_require_pytest)
  find_program(PINNQUAD_TEST_PYTHON python3 HINTS /usr/bin DOC "Runs the tests of the programs; has pytest")
  mark_as_advanced(PINNQUAD_TEST_PYTHON)
  execute_process(COMMAND "${PINNQUAD_TEST_PYTHON}" -c "import pytest" RESULT_VARIABLE _pytest_missing ERROR_QUIET)
  if(_pytest_missing)
    message(FATAL_ERROR
      "pinnquad: the tests (PINNQUAD_BUILD_TESTS) need pytest, which ${PINNQUAD_TEST_PYTHON} does not have. "
      "On Debian or Ubuntu, as root: apt-get install python3-pytest")
  endif()
endmacro()

# pinnquad_part(<option> <what> [<package>...]): a part that ON demands and OFF leaves out. AUTO, the default, builds it
# where pinnquad is the top-level project and the packages are there.
macro(pinnquad_part option what)
  set(${option} AUTO CACHE STRING "Build ${what}: ON, OFF, or AUTO, which is where pinnquad is top-level and finds what it needs (${ARGN})")
  set_property(CACHE ${option} PROPERTY STRINGS AUTO ON OFF)
  if(${option} STREQUAL "AUTO")
    set(${option} ${PROJECT_IS_TOP_LEVEL})
    set(_part_lacks "")
    if(PROJECT_IS_TOP_LEVEL)
      foreach(_part_package IN ITEMS ${ARGN})
        find_package(${_part_package} QUIET NO_MODULE)
        if(NOT ${_part_package}_FOUND)
          list(APPEND _part_lacks ${_part_package})
        endif()
      endforeach()
    endif()
    if(_part_lacks)
      set(${option} OFF)
      list(JOIN _part_lacks ", " _part_lacks)
      list(APPEND _parts_off "${what} (no ${_part_lacks})")
    endif()
  endif()
endmacro()

# pinnquad_say_what_is_off(): one line of the parts that AUTO left out, and why.
macro(pinnquad_say_what_is_off)
  if(_parts_off)
    list(JOIN _parts_off ", " _parts_off)
    message(STATUS "pinnquad: not built: ${_parts_off}; the library is complete without")
  endif()
  unset(_parts_off)
endmacro()
