# SPDX-License-Identifier: MIT
#
# The bodies of include/pinnquad/**/impl, compiled once for tests, programs and Python (PINNQUAD_COMPILED, core/body.hpp): one
# source a room. Never installed: a user's project includes them.
file(GLOB bodies CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/include"
  "${PROJECT_SOURCE_DIR}/include/pinnquad/*/impl/*.hpp" "${PROJECT_SOURCE_DIR}/include/pinnquad/*/*/impl/*.hpp")
foreach(body IN LISTS bodies)
  string(REGEX MATCH "^pinnquad/([a-z]+)/" room "${body}")
  set(room ${CMAKE_MATCH_1})
  list(APPEND compiled_rooms ${room})
  string(APPEND bodies_of_${room} "#include \"${body}\"\n")
endforeach()
list(REMOVE_DUPLICATES compiled_rooms)
add_library(pinnquad_compiled STATIC EXCLUDE_FROM_ALL)
foreach(room IN LISTS compiled_rooms)
  set(source "${PROJECT_BINARY_DIR}/compiled/${room}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "${bodies_of_${room}}" @ONLY)
  target_sources(pinnquad_compiled PRIVATE "${source}")
endforeach()
set(optimisation -O2) # it trains
if(PINNQUAD_BUILD_TESTS AND NOT PINNQUAD_BUILD_TOOLS)
  set(optimisation -O1) # for tests alone, which take longer to compile than to run
endif()
target_compile_options(pinnquad_compiled PRIVATE $<$<CONFIG:Release>:${optimisation}>)
if(PINNQUAD_BUILD_TESTS)
  target_compile_options(pinnquad_compiled PRIVATE -UNDEBUG) # tests want assertions, whatever the build type
endif()
set_target_properties(pinnquad_compiled PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_compile_definitions(pinnquad_compiled PUBLIC PINNQUAD_COMPILED)
target_link_libraries(pinnquad_compiled PUBLIC pinnquad::pinnquad PRIVATE pinnquad_flags)
