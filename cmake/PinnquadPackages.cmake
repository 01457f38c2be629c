# SPDX-License-Identifier: MIT
#
# pinnquad_require_package(<name> DEBIAN <package> NEEDED_FOR <what> [VERSION <version>])
# find_package in config mode that, when it fails, says what to install instead of where it looked.
macro(pinnquad_require_package name)
  cmake_parse_arguments(_require "" "VERSION;DEBIAN;NEEDED_FOR" "" ${ARGN})
  find_package(${name} ${_require_VERSION} QUIET NO_MODULE)
  if(NOT ${name}_FOUND)
    message(FATAL_ERROR
      "pinnquad: ${_require_NEEDED_FOR} need(s) ${name} ${_require_VERSION}, which was not found. "
      "On Debian or Ubuntu, as root: apt-get install ${_require_DEBIAN}")
  endif()
endmacro()
