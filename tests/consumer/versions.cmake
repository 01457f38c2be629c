# SPDX-License-Identifier: MIT
#
# Packages of other versions, stood in for in WORK. Eigen: 3.4 and 5 are taken, by the source tree SOURCE_DIR and by what is
# installed in PREFIX; 3.3 is too old, which is another message than that there is none.
cmake_minimum_required(VERSION 3.22)
include(CMakePackageConfigHelpers)
file(REMOVE_RECURSE "${WORK}")

# stand_in(<name> <version> <target>): in WORK/<name>-<version>
function(stand_in name version target)
  set(folder "${WORK}/${name}-${version}/share/cmake/${name}")
  file(WRITE "${folder}/${name}Config.cmake" "add_library(${target} INTERFACE IMPORTED)\n")
  write_basic_package_version_file("${folder}/${name}ConfigVersion.cmake"
    VERSION ${version} COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
endfunction()

# configured(<what> <expected code> <words> <argument>...): its output, blanks as one, has the words
function(configured what expected words)
  execute_process(COMMAND "${CMAKE_COMMAND}" -G "${GENERATOR}" ${ARGN} "-DCMAKE_CXX_COMPILER=${COMPILER}"
    "-DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM}"
    -DCMAKE_CXX_COMPILER_FORCED=ON --no-warn-unused-cli RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  string(REGEX REPLACE "[ \n]+" " " said "${said}")
  if(NOT code EQUAL expected OR NOT said MATCHES "${words}")
    message(SEND_ERROR "${what}: expected exit code ${expected} and '${words}', found ${code} and: ${said}")
  endif()
endfunction()

foreach(version IN ITEMS 3.3.9 3.4.0 5.0.1)
  stand_in(Eigen3 ${version} Eigen3::Eigen)
endforeach()
# what this machine has is not looked at
set(alone -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF
  -DCMAKE_FIND_USE_CMAKE_ENVIRONMENT_PATH=OFF -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
set(off "")
foreach(part IN ITEMS TESTS EXAMPLES TOOLS LOGS BENCH)
  list(APPEND off "-DPINNQUAD_BUILD_${part}=OFF")
endforeach()
file(WRITE "${WORK}/user/CMakeLists.txt"
  "cmake_minimum_required(VERSION 3.22)\nproject(user LANGUAGES NONE)\nfind_package(pinnquad REQUIRED)\n")
foreach(way IN ITEMS source installed)
  if(way STREQUAL "source")
    set(from -S "${SOURCE_DIR}" ${off} ${alone})
    set(needs "pinnquad: every pinnquad header need.s. ")
  else()
    set(from -S "${WORK}/user" "-Dpinnquad_DIR=${PREFIX}/share/cmake/pinnquad" ${alone})
    set(needs "pinnquad needs ")
  endif()
  foreach(version IN ITEMS 3.4.0 5.0.1)
    configured("${way}, Eigen ${version}" 0 "" ${from} -B "${WORK}/${way}-${version}" "-DCMAKE_PREFIX_PATH=${WORK}/Eigen3-${version}")
  endforeach()
  configured("${way}, Eigen 3.3.9" 1 "${needs}Eigen3 3.4 or newer; version 3.3.9 is too old, found in [^ ]*Eigen3-3.3.9"
    ${from} -B "${WORK}/${way}-3.3.9" "-DCMAKE_PREFIX_PATH=${WORK}/Eigen3-3.3.9")
  configured("${way}, no Eigen" 1 "${needs}Eigen3 3.4 or newer, which was not found" ${from} -B "${WORK}/${way}-none")
endforeach()
