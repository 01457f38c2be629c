# SPDX-License-Identifier: MIT
#
# How pinnquad's own tests, benches and examples are compiled. Linked PRIVATE by them, never exported:
# a user's flags are the user's.
add_library(pinnquad_warnings INTERFACE)
if(PINNQUAD_BUILD_TOOLS OR NOT PINNQUAD_BUILD_PYTHON) # who installs the Python package sees none: 3 % of its time to compile
  target_compile_options(pinnquad_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow
    $<$<BOOL:${PINNQUAD_WARNINGS_AS_ERRORS}>:-Werror>)
endif()
# for tests that call a compiler themselves
set(pinnquad_werror "")
if(PINNQUAD_WARNINGS_AS_ERRORS)
  set(pinnquad_werror -Werror)
endif()

# The benches link the warnings alone: they measure what a user's flags give. All else is reproducible:
add_library(pinnquad_flags INTERFACE)
target_link_libraries(pinnquad_flags INTERFACE pinnquad_warnings)
target_compile_options(pinnquad_flags INTERFACE
  # With FMA hardware (-march=native) gcc fuses a*b+c across statements and clang only within one, so the same
  # source gives different last bits. Without contraction both give the same flights and the same weights;
  # where a fused operation is wanted (the kernels) it is written as one.
  -ffp-contract=off)

# gcc 12's straight-line vectoriser makes vfmaddsub of separate products and sums, whatever -ffp-contract says.
# Its garbage it otherwise collects from 4 MiB on, again and again: an eighth of the time of a heavy translation unit.
# From 550 MB on the heaviest unit of the program stays within 1 GB; with 400 MB those of Python's module do.
set(collection --param=ggc-min-heapsize=550000 --param=ggc-min-expand=20)
if(PINNQUAD_BUILD_PYTHON AND NOT PINNQUAD_BUILD_TOOLS)
  set(collection --param=ggc-min-heapsize=400000 --param=ggc-min-expand=30)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(pinnquad_flags INTERFACE -fno-tree-slp-vectorize ${collection})
endif()

# gcc 16.2 dies at -O1 of the conjunction of lanes' truths in is_plain() (reassoc_stmt_dominates_stmt_p); of floating-point numbers
# that pass changes nothing without fast-math.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 16)
  target_compile_options(pinnquad_flags INTERFACE -fno-tree-reassoc)
endif()

# gcc calls the deliberately undefined operands inside its own AVX-512 intrinsics uninitialised, where Eigen uses them
# (gcc 12 with Eigen 3.4, gcc 16 with Eigen 5); the warning stays on where no such instruction set is targeted.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "-march=|-mavx512")
  target_compile_options(pinnquad_warnings INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
endif()

# Both, and the bodies that are compiled once.
set(optimisation -O2) # it trains
if(PINNQUAD_BUILD_TESTS AND NOT PINNQUAD_BUILD_TOOLS)
  set(optimisation -O1) # for tests alone, which take longer to compile than to run
endif()
target_compile_options(pinnquad_compiled PRIVATE $<$<CONFIG:Release>:${optimisation}>)
if(PINNQUAD_BUILD_TESTS)
  target_compile_options(pinnquad_compiled PRIVATE -UNDEBUG) # tests want assertions, whatever the build type
endif()
target_link_libraries(pinnquad_compiled PRIVATE pinnquad_flags)
add_library(pinnquad_development INTERFACE)
target_link_libraries(pinnquad_development INTERFACE pinnquad_flags pinnquad_compiled)

# pinnquad_state_build_flags(<target>): its reports name the flags that the build was configured with.
function(pinnquad_state_build_flags target)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}" build_flags)
  string(REGEX REPLACE " +" " " build_flags "${build_flags}")
  target_compile_definitions(${target} PRIVATE "PINNQUAD_BUILD_FLAGS=\"${build_flags}\"")
endfunction()

set(PINNQUAD_UNOPTIMISED "" CACHE STRING
  "Rooms whose tests are compiled with -O0: what takes longer to optimise than to run as it is")

option(PINNQUAD_BUILD_AT_ONCE
  "Compile programs and tests for a build from nothing (scripts/test, scripts/demo): several sources at once, up to half less. Off for
  who edits: one changed source costs its neighbours too" OFF)
# pinnquad_at_once(<target> <count>): so many of its sources are compiled together where PINNQUAD_BUILD_AT_ONCE says so.
function(pinnquad_at_once target count)
  set_target_properties(${target} PROPERTIES UNITY_BUILD "${PINNQUAD_BUILD_AT_ONCE}" UNITY_BUILD_BATCH_SIZE ${count})
endfunction()
