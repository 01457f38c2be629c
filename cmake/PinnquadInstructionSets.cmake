# SPDX-License-Identifier: MIT
#
# What is shipped runs on every x86-64, and as fast as each allows: builds for more instruction sets stand beside it, and the
# best is taken when it starts (tools/command_line/best_build.hpp). Each is made in a build tree of its own, by this one's
# settings: objects of different sets never meet.
include(CheckCXXCompilerFlag)
set(PINNQUAD_INSTRUCTION_SETS "" CACHE STRING
  "Instruction sets beside that of CMAKE_CXX_FLAGS for which program and Python module are built: x86-64-v3;x86-64-v4, or none")

foreach(set IN LISTS PINNQUAD_INSTRUCTION_SETS)
  string(MAKE_C_IDENTIFIER "PINNQUAD_COMPILES_FOR_${set}" compiles)
  check_cxx_compiler_flag("-march=${set}" ${compiles})
  if(NOT ${compiles})
    message(STATUS "pinnquad: nothing is built for ${set}: the compiler has no -march=${set}")
    list(REMOVE_ITEM PINNQUAD_INSTRUCTION_SETS "${set}")
  endif()
endforeach()

# pinnquad_also_for_instruction_sets(<target> <built> <stem> [<ending>]): <built>, a file of the build tree that <target> makes,
# for each set as the file <stem>-<set><ending>.
function(pinnquad_also_for_instruction_sets target built stem)
  if(NOT PINNQUAD_INSTRUCTION_SETS)
    return()
  endif()
  set(settings "")
  get_cmake_property(names CACHE_VARIABLES)
  foreach(name IN LISTS names)
    get_property(type CACHE "${name}" PROPERTY TYPE)
    if(type MATCHES "^(BOOL|STRING|PATH|FILEPATH|UNINITIALIZED)$")
      string(REPLACE UNINITIALIZED STRING type "${type}")
      string(APPEND settings "set(${name} [==[$CACHE{${name}}]==] CACHE ${type} \"\" FORCE)\n")
    endif()
  endforeach()
  file(WRITE "${PROJECT_BINARY_DIR}/instruction_sets/settings.cmake" "${settings}")
  foreach(set IN LISTS PINNQUAD_INSTRUCTION_SETS)
    set(tree "${PROJECT_BINARY_DIR}/instruction_sets/${set}")
    add_custom_target(${target}_${set} ALL
      COMMAND "${CMAKE_COMMAND}" -S "${PROJECT_SOURCE_DIR}" -B "${tree}" -G "${CMAKE_GENERATOR}"
        -C "${PROJECT_BINARY_DIR}/instruction_sets/settings.cmake" "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS} -march=${set}"
        "-DCMAKE_EXE_LINKER_FLAGS=${CMAKE_EXE_LINKER_FLAGS} -s" -DPINNQUAD_INSTRUCTION_SETS= -DPINNQUAD_BUILD_TESTS=OFF
      COMMAND "${CMAKE_COMMAND}" --build "${tree}" --target ${target}
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${PROJECT_BINARY_DIR}/libexec"
      COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${tree}/${built}" "${PROJECT_BINARY_DIR}/${stem}-${set}${ARGV3}"
      COMMENT "${target} for ${set}"
      USES_TERMINAL VERBATIM)
    add_dependencies(${target}_${set} ${target} ${before}) # one after the other: each takes all cores
    set(before ${target}_${set})
  endforeach()
endfunction()
