# SPDX-License-Identifier: MIT
#
# Installs BUILD_DIR into an emptied PREFIX, and finds headers and package files there and nothing else. The consumers'
# build trees go too: a cache would keep the defaults of options from the last run.
cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE "${PREFIX}" "${TREES}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${PREFIX}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the installation failed:\n${output}")
endif()

file(GLOB_RECURSE installed RELATIVE "${PREFIX}" "${PREFIX}/*")
foreach(file IN LISTS installed)
  if(NOT file MATCHES "^include/pinnquad/.*\\.hpp$" AND
      NOT file MATCHES "^share/cmake/pinnquad/pinnquad(Config|ConfigVersion|Targets)\\.cmake$")
    message(FATAL_ERROR "installed, but neither a header nor a package file: ${file}")
  endif()
endforeach()
foreach(file IN ITEMS include/pinnquad/version.hpp share/cmake/pinnquad/pinnquadConfig.cmake)
  if(NOT file IN_LIST installed)
    message(FATAL_ERROR "not installed: ${file}")
  endif()
endforeach()

# a package that knows where it was built can't be moved
file(GLOB package_files "${PREFIX}/share/cmake/pinnquad/*.cmake")
foreach(file IN LISTS package_files)
  file(READ "${file}" text)
  string(FIND "${text}" "${BUILD_DIR}" at)
  if(at GREATER -1)
    message(FATAL_ERROR "${file} names the build tree")
  endif()
endforeach()
