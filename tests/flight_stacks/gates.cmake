# SPDX-License-Identifier: MIT
#
# The compile gates, through flight/check_symbols.cmake: -fno-exceptions -fno-rtti -Wall -Wextra -Wshadow -Wconversion
# -Wdouble-promotion are always on. What is added are flags that the two projects publish (PX4 v1.16:
# cmake/px4_add_common_flags.cmake; Crazyflie: its Makefile). Left out: -Wmissing-braces, which the Crazyflie sets for C.
set(px4_flags "-fdata-sections -ffunction-sections -fomit-frame-pointer -funsafe-math-optimizations \
-fno-strict-aliasing -fno-math-errno -fvisibility=hidden -fcheck-new -fno-threadsafe-statics -Warray-bounds -Wcast-align \
-Wdisabled-optimization -Wfatal-errors -Wfloat-equal -Wformat-security -Winit-self -Wpointer-arith \
-Wuninitialized -Wunused-variable -Wunused-but-set-variable")
set(crazyflie_flags "-fno-math-errno -fno-strict-aliasing -ffunction-sections -fdata-sections -Wfloat-equal -Wcast-align")
set(px4_source "${CMAKE_CURRENT_SOURCE_DIR}/px4_gate.cpp")
set(crazyflie_source "${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src/neural_control_core.cpp")
set(px4_machine "-mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-d16")
set(crazyflie_machine "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16")

find_program(PINNQUAD_ARM_CXX arm-none-eabi-g++ DOC "Cortex-M compiler, for the compile gates of the flight stacks")
find_program(PINNQUAD_ARM_NM arm-none-eabi-nm)
mark_as_advanced(PINNQUAD_ARM_CXX PINNQUAD_ARM_NM)

# _pinnquad_add_stack_gate(<name> <source> <compiler> <nm> <flags>)
function(_pinnquad_add_stack_gate name source compiler nm flags)
  add_test(NAME ${name}
    COMMAND "${CMAKE_COMMAND}"
      "-DCOMPILER=${compiler}" "-DNM=${nm}" "-DINCLUDE_DIR=${PROJECT_SOURCE_DIR}/include"
      "-DEIGEN_INCLUDE_DIR=${eigen_include}" "-DSOURCE=${source}" "-DOBJECT=${CMAKE_CURRENT_BINARY_DIR}/${name}.o"
      "-DFLAGS=${flags} ${pinnquad_werror} -I${PROJECT_SOURCE_DIR}/examples -I${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src"
      -P "${PROJECT_SOURCE_DIR}/tests/flight/check_symbols.cmake")
  set_tests_properties(${name} PROPERTIES LABELS flight_stacks)
endfunction()

# The stack that functions take, by the compiler's own count; `limits`: function and bytes, by turns. A folder besides has a
# model, and limits of trust, in place of the stack's own.
function(_pinnquad_add_stack_test stack optimisation limits)
  set(folder "${stack}")
  if(ARGC GREATER 3)
    set(folder "${ARGV3}")
  endif()
  set(name "flight_stacks.stack.${folder}.cortex_m${optimisation}")
  set(defined "")
  if(folder MATCHES "_onboard$")
    set(defined "-DPINNQUAD_ONBOARD") # a vehicle that is learnt in flight
  endif()
  if(PINNQUAD_ARM_CXX AND Python3_Interpreter_FOUND)
    set(depths "")
    while(limits)
      list(POP_FRONT limits function bytes)
      string(APPEND depths "; \"$1\" \"$2/tests/flight_stacks/stack_depth.py\" ${name}.ci ${function} ${bytes}")
    endwhile()
    add_test(NAME "${name}" COMMAND bash -c "set -e; \"$0\" -std=c++17 ${optimisation} ${${stack}_flags} ${${stack}_machine} \
-fno-exceptions -fno-rtti -fcallgraph-info=su -I\"$2/include\" -I\"$2/examples\" -I\"$2/examples/crazyflie_app/src\" \
-I\"$2/tests/flight_stacks/${folder}\" ${defined} -isystem \"$3\" -c \"$4\" -o ${name}.o${depths}"
      "${PINNQUAD_ARM_CXX}" "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}" "${eigen_include}" "${${stack}_source}")
    set_tests_properties("${name}" PROPERTIES LABELS flight_stacks)
  else()
    add_test(NAME "${name}" COMMAND bash -c "echo 'skipped: no arm-none-eabi-g++ or python3'; exit 77")
    set_tests_properties("${name}" PROPERTIES LABELS flight_stacks SKIP_RETURN_CODE 77)
  endif()
  pinnquad_thorough("${name}")
endfunction()

# The Crazyflie's step: PINNQUAD_STEP_STACK_BYTES of the glue is the limit. PX4's: that of the queue rate_ctrl of v1.16. A block is
# tested on the stack that the module's CMakeLists.txt asks for, less what the glue and the file system take of it.
file(STRINGS "${crazyflie_glue}" crazyflie_step REGEX "^#define PINNQUAD_STEP_STACK_BYTES ")
string(REGEX REPLACE "[^0-9]" "" crazyflie_step "${crazyflie_step}")
file(STRINGS "${crazyflie_source}" crazyflie_start REGEX "past_stack_words = ")
string(REGEX REPLACE ".*past_stack_words = ([0-9]+).*" "\\1" crazyflie_start "${crazyflie_start}")
math(EXPR crazyflie_start "4 * ${crazyflie_start} - 400")
set(px4_step 3150)
file(READ "${PROJECT_SOURCE_DIR}/examples/px4_module/CMakeLists.txt" px4_start)
if(px4_start MATCHES "STACK_MAIN ([0-9]+)")
  math(EXPR px4_start "${CMAKE_MATCH_1} - 1500")
else()
  math(EXPR px4_start "2048 - 1500") # PX4's default
endif()

get_target_property(eigen_include Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)

# As PX4 builds for a board.
if(PINNQUAD_ARM_CXX)
  add_test(NAME flight_stacks.px4_build.nuttx COMMAND "${CMAKE_COMMAND}" -G Ninja
    -S "${CMAKE_CURRENT_SOURCE_DIR}/px4_build" -B "${CMAKE_CURRENT_BINARY_DIR}/px4_build_nuttx" -DPX4_PLATFORM=nuttx
    "-DCMAKE_CXX_COMPILER=${PINNQUAD_ARM_CXX}" "-DCMAKE_CXX_FLAGS=${px4_machine}" -DCMAKE_SYSTEM_NAME=Generic
    -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY "-DMODULE_DIR=${PROJECT_SOURCE_DIR}/examples/px4_module"
    "-DPINNQUAD_EIGEN_DIR=${eigen_include}")
else()
  add_test(NAME flight_stacks.px4_build.nuttx COMMAND bash -c "echo 'skipped: no arm-none-eabi-g++'; exit 77")
endif()
set_tests_properties(flight_stacks.px4_build.nuttx PROPERTIES LABELS flight_stacks SKIP_RETURN_CODE 77)
find_package(Python3 COMPONENTS Interpreter)
_pinnquad_add_stack_test(crazyflie -Os "pinnquad_flight_step;${crazyflie_step}") # as the firmware is built
_pinnquad_add_stack_test(crazyflie -Os "pinnquad_flight_step;${crazyflie_step}" crazyflie_trusting)
_pinnquad_add_stack_test(crazyflie -Os "pinnquad_flight_step;${crazyflie_step}" crazyflie_onboard)
# a window of nine instants; what a block is tested on is what the core asks of the app's task, less what that task takes
_pinnquad_add_stack_test(crazyflie -Os
  "pinnquad_flight_step;${crazyflie_step};pinnquad_flight_offer_model;${crazyflie_start}" crazyflie_past)
foreach(folder IN ITEMS px4 px4_past)
  _pinnquad_add_stack_test(px4 -Os
    "pinnquad_flight_px4_run_recorded;${px4_step};pinnquad_flight_px4_run_learning;${px4_step};pinnquad_flight_px4_offer_model;${px4_start}" "${folder}")
endforeach()
_pinnquad_add_stack_gate(flight_stacks.gate.crazyflie_past.host-O2 "${crazyflie_source}" "${CMAKE_CXX_COMPILER}" "${CMAKE_NM}"
  "-O2 ${crazyflie_flags} -I${CMAKE_CURRENT_SOURCE_DIR}/crazyflie_past")
pinnquad_thorough(flight_stacks.gate.crazyflie_past.host-O2)
# for the microcontroller as both firmwares are built
foreach(stack IN ITEMS px4 crazyflie)
  _pinnquad_add_stack_gate("flight_stacks.gate.${stack}.host-O2" "${${stack}_source}" "${CMAKE_CXX_COMPILER}" "${CMAKE_NM}"
    "-O2 ${${stack}_flags}")
  if(stack STREQUAL "crazyflie") # one core stands for both without --all
    pinnquad_thorough(flight_stacks.gate.crazyflie.host-O2)
  endif()
  set(name "flight_stacks.gate.${stack}.cortex_m-Os")
  if(PINNQUAD_ARM_CXX AND PINNQUAD_ARM_NM)
    _pinnquad_add_stack_gate("${name}" "${${stack}_source}" "${PINNQUAD_ARM_CXX}" "${PINNQUAD_ARM_NM}"
      "-Os ${${stack}_flags} ${${stack}_machine}")
  else()
    add_test(NAME "${name}" COMMAND bash -c "echo 'skipped: no arm-none-eabi-g++ (Debian: gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib)'; exit 77")
    set_tests_properties("${name}" PROPERTIES LABELS flight_stacks SKIP_RETURN_CODE 77)
  endif()
  pinnquad_thorough("${name}")
endforeach()
