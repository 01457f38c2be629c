# SPDX-License-Identifier: MIT
#
# Packages of other versions, stood in for in WORK. Eigen: 3.4 and 5 are taken, by the source tree SOURCE_DIR and by what is
# installed in PREFIX; 3.3 is too old, which is another message than that there is none. ONNX: the targets of its messages before and
# from 1.17 on are found; a line says what is left out.
cmake_minimum_required(VERSION 3.22)
include(CMakePackageConfigHelpers)
file(REMOVE_RECURSE "${WORK}")

# stand_in(<name> <version> <target> [<what it links>]): in WORK/<name>-<version>
function(stand_in name version target)
  set(folder "${WORK}/${name}-${version}/share/cmake/${name}")
  file(WRITE "${folder}/${name}Config.cmake" "add_library(${target} INTERFACE IMPORTED)\n"
    "set_target_properties(${target} PROPERTIES INTERFACE_LINK_LIBRARIES \"${ARGN}\")\n")
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

stand_in(ONNX 1.12.0 onnx_proto protobuf::libprotobuf)
stand_in(ONNX 1.17.0 ONNX::onnx_proto protobuf::libprotobuf)
stand_in(ONNX 1.20.0 ONNX::onnx_proto) # Debian's says nothing of protobuf's light library, which it needs
stand_in(ONNX 9.0.0 ONNX::other)
file(WRITE "${WORK}/onnx/CMakeLists.txt" "cmake_minimum_required(VERSION 3.22)\nproject(onnx LANGUAGES CXX)\n"
  "add_library(protobuf::libprotobuf INTERFACE IMPORTED)\ninclude(\"${SOURCE_DIR}/cmake/PinnquadPackages.cmake\")\n"
  "pinnquad_find_onnx(onnx)\nmessage(STATUS \"found <\${onnx}>\")\n")
set(left_out "-- pinnquad: pinnquad convert reads and writes no ONNX ")
foreach(expected IN ITEMS "1.12.0=<onnx_proto>" "1.17.0=<ONNX::onnx_proto>"
    "1.20.0=<ONNX::onnx_proto.protobuf::libprotobuf-lite>" "9.0.0=${left_out}.ONNX in [^ ]*9.0.0[^ ]* has no target")
  string(REGEX MATCH "^([0-9.]+)=(.*)$" expected "${expected}")
  set(words "${CMAKE_MATCH_2}")
  configured("ONNX ${CMAKE_MATCH_1}" 0 "${words}" -S "${WORK}/onnx" -B "${WORK}/onnx-${CMAKE_MATCH_1}"
    "-DONNX_DIR=${WORK}/ONNX-${CMAKE_MATCH_1}/share/cmake/ONNX")
endforeach()
configured("no ONNX" 0 "${left_out}.no libonnx-dev" -S "${WORK}/onnx" -B "${WORK}/onnx-none" -DCMAKE_DISABLE_FIND_PACKAGE_ONNX=ON)
