# SPDX-License-Identifier: MIT
#
# pinnquad::compiled: pinnquad::pinnquad, and a static library of the bodies of include/pinnquad/**/impl (PINNQUAD_COMPILED,
# core/body.hpp), one source a room. Built in the project that links it, with that project's flags; nothing else builds it.

# pinnquad_add_compiled(<include folder>): of the source tree, or of an installed one.
function(pinnquad_add_compiled include)
  if(TARGET pinnquad_compiled OR NOT CMAKE_CXX_COMPILE_FEATURES) # of a project without C++, or an unknown compiler
    return()
  endif()
  file(GLOB bodies CONFIGURE_DEPENDS RELATIVE "${include}"
    "${include}/pinnquad/*/impl/*.hpp" "${include}/pinnquad/*/*/impl/*.hpp")
  foreach(body IN LISTS bodies)
    string(REGEX MATCH "^pinnquad/([a-z]+)/" room "${body}")
    set(room ${CMAKE_MATCH_1})
    list(APPEND rooms ${room})
    string(APPEND bodies_of_${room} "#include \"${body}\"\n")
  endforeach()
  list(REMOVE_DUPLICATES rooms)
  add_library(pinnquad_compiled STATIC EXCLUDE_FROM_ALL)
  foreach(room IN LISTS rooms)
    set(source "${CMAKE_CURRENT_BINARY_DIR}/pinnquad_compiled/${room}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "${bodies_of_${room}}" @ONLY)
    target_sources(pinnquad_compiled PRIVATE "${source}")
  endforeach()
  set_target_properties(pinnquad_compiled PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_definitions(pinnquad_compiled PUBLIC PINNQUAD_COMPILED)
  target_link_libraries(pinnquad_compiled PUBLIC pinnquad::pinnquad)
  add_library(pinnquad::compiled ALIAS pinnquad_compiled)
endfunction()
