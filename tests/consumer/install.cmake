# SPDX-License-Identifier: MIT
#
# Installs SOURCE_DIR into an emptied PREFIX, configured with Eigen alone and without a build, and finds headers and
# package files there and nothing else; the build tree BUILD_DIR, where all is built, adds the program pinnquad. The consumers'
# build trees go too: a cache would keep the defaults of options from the last run.
cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE "${PREFIX}" "${TREES}")
set(hidden "")
foreach(package IN ITEMS doctest CLI11 nlohmann_json tomlplusplus kainjow_mustache benchmark Threads Torch Python pybind11)
  list(APPEND hidden "-DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON")
endforeach()

# run(<what> <command>...): its output in said
macro(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${what} failed:\n${said}")
  endif()
endmacro()

run("configuring with Eigen alone" "${CMAKE_COMMAND}" -S "${SOURCE_DIR}" -B "${TREES}/eigen_alone" -G "${GENERATOR}"
  "-DCMAKE_CXX_COMPILER=${COMPILER}" ${hidden})
if(NOT said MATCHES "\n-- pinnquad: not built: the tests \\(no doctest\\), the program pinnquad \\(no CLI11, nlohmann_json, tomlplusplus, kainjow_mustache\\), the library pinnquad::logs \\(no nlohmann_json, tomlplusplus\\), the benchmarks \\(no benchmark\\);[^\n]*\n")
  message(FATAL_ERROR "configured without doctest, CLI11, nlohmann_json, tomlplusplus, kainjow_mustache and benchmark, and no line says what is off:\n${said}")
endif()
run("the installation" "${CMAKE_COMMAND}" --install "${TREES}/eigen_alone" --prefix "${PREFIX}")
run("the installation of the tree with tests" "${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${TREES}/prefix")

# what is asked for and can't be had is an error that names the package
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${SOURCE_DIR}" -B "${TREES}/asked" -G "${GENERATOR}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" ${hidden} -DPINNQUAD_BUILD_BENCH=ON
  RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE said)
string(REGEX REPLACE "[ \n]+" " " said "${said}")
if(code EQUAL 0 OR NOT said MATCHES "need\\(s\\) benchmark, which was not found.* as root: apt-get install libbenchmark-dev")
  message(FATAL_ERROR "PINNQUAD_BUILD_BENCH=ON without the package benchmark said:\n${said}")
endif()

file(GLOB_RECURSE installed RELATIVE "${PREFIX}" "${PREFIX}/*")
foreach(file IN LISTS installed)
  if(NOT file MATCHES "^include/pinnquad/.*\\.hpp$" AND
      NOT file MATCHES "^share/(cmake/pinnquad/pinnquad(Config|ConfigVersion|Targets)\\.cmake|pkgconfig/pinnquad\\.pc)$")
    message(FATAL_ERROR "installed, but neither a header nor a package file: ${file}")
  endif()
endforeach()
file(GLOB_RECURSE installed_with_tests RELATIVE "${TREES}/prefix" "${TREES}/prefix/*")
set(of_programs share/pinnquad/watch.json share/pinnquad/charts.json) # by npm
foreach(program IN ITEMS pinnquad pinnquad-study)
  set(always bin/${program} share/bash-completion/completions/${program})
  list(APPEND of_programs ${always} share/man/man1/${program}.1) # the last by help2man
  if(EXISTS "${BUILD_DIR}/bin/${program}")
    foreach(file IN LISTS always)
      if(NOT file IN_LIST installed_with_tests)
        message(FATAL_ERROR "not installed: ${file}")
      endif()
    endforeach()
    run("the installed program" "${TREES}/prefix/bin/${program}" --version)
  endif()
endforeach()
list(REMOVE_ITEM installed_with_tests ${of_programs})
# the report of a study, in Python: a link to it, and what it reads
list(FILTER installed_with_tests EXCLUDE REGEX "^(bin/pinnquad-study-report|share/pinnquad/(study|page)/[a-z0-9_]+[.](py|html|css))$")
# pinnquad::logs, where what it needs is there and it was built
list(FILTER installed_with_tests EXCLUDE REGEX
  "^(include/pinnquad/logs/|lib[^/]*/(.*/)?libpinnquad_logs[.]a$|share/cmake/pinnquad/pinnquadLogsTargets)")
if(NOT installed_with_tests STREQUAL installed)
  message(FATAL_ERROR "with Eigen alone other files are installed:\n${installed}\nthan with the tests:\n${installed_with_tests}")
endif()
foreach(file IN ITEMS include/pinnquad/version.hpp share/cmake/pinnquad/pinnquadConfig.cmake)
  if(NOT file IN_LIST installed)
    message(FATAL_ERROR "not installed: ${file}")
  endif()
endforeach()

# a package that knows where it was built can't be moved
file(GLOB package_files "${PREFIX}/share/cmake/pinnquad/*.cmake")
foreach(file IN LISTS package_files)
  file(READ "${file}" text)
  foreach(tree IN ITEMS "${BUILD_DIR}" "${TREES}")
    string(FIND "${text}" "${tree}" at)
    if(at GREATER -1)
      message(FATAL_ERROR "${file} names the build tree")
    endif()
  endforeach()
endforeach()
