# SPDX-License-Identifier: MIT
#
# Included by the consumers: what pinnquad's targets bring along, and what pinnquad left behind in the project.
foreach(target IN ITEMS pinnquad::flight pinnquad::pinnquad)
  if(NOT TARGET ${target})
    message(FATAL_ERROR "no target ${target}")
  endif()
  foreach(property IN ITEMS COMPILE_OPTIONS COMPILE_DEFINITIONS LINK_OPTIONS)
    get_target_property(value ${target} INTERFACE_${property})
    if(value)
      message(FATAL_ERROR "${target} leaks ${property}: ${value}")
    endif()
  endforeach()
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  if(NOT links MATCHES "^(Eigen3::Eigen|pinnquad_flight|pinnquad::flight)$")
    message(FATAL_ERROR "${target} links more than Eigen: ${links}")
  endif()
endforeach()

if(NOT CMAKE_CXX_FLAGS STREQUAL "")
  message(FATAL_ERROR "CMAKE_CXX_FLAGS was changed: ${CMAKE_CXX_FLAGS}")
endif()

# pinnquad as a subproject: its two interface targets and the bodies of one, no tests, benches, examples, and no install rules
# Whatever a user warns of, headers of a subproject are silent, as installed ones are: they are system headers.
set(user_warnings -Wall -Wextra -Wpedantic -Weffc++ -Wold-style-cast -Wfloat-equal -Wconversion -Wsign-conversion
  -Wcast-align -Wundef -Wunused)
function(check_subproject source_dir)
  get_property(targets DIRECTORY "${source_dir}" PROPERTY BUILDSYSTEM_TARGETS)
  list(SORT targets)
  if(NOT targets STREQUAL "pinnquad;pinnquad_compiled;pinnquad_flight")
    message(FATAL_ERROR "a subproject pinnquad has other targets: ${targets}")
  endif()
  get_property(subdirectories DIRECTORY "${source_dir}" PROPERTY SUBDIRECTORIES)
  if(subdirectories)
    message(FATAL_ERROR "a subproject pinnquad adds folders: ${subdirectories}")
  endif()
endfunction()
