# SPDX-License-Identifier: MIT
#
# pinnquad_read_version(<version.hpp> <variable>): "major.minor.patch" from the header that states it.
function(pinnquad_read_version header variable)
  file(READ "${header}" text)
  set(numbers "")
  foreach(part IN ITEMS MAJOR MINOR PATCH)
    if(NOT text MATCHES "#define PINNQUAD_VERSION_${part} ([0-9]+)")
      message(FATAL_ERROR "${header}: no '#define PINNQUAD_VERSION_${part} <number>'")
    endif()
    list(APPEND numbers "${CMAKE_MATCH_1}")
  endforeach()
  list(JOIN numbers "." version)
  set(${variable} "${version}" PARENT_SCOPE)
  # a changed version configures anew
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${header}")
endfunction()
