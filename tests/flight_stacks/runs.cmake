# SPDX-License-Identifier: MIT
#
# The cores and the glue run, and the build files of the stacks configure: included by CMakeLists.txt.
add_library(flight_stacks_crazyflie_glue OBJECT "${crazyflie_glue}")
target_include_directories(flight_stacks_crazyflie_glue PRIVATE "${crazyflie_headers}" "${stand_in}/crazyflie")
set_target_properties(flight_stacks_crazyflie_glue PROPERTIES C_STANDARD 11)
# With no include path but the library's, as in the firmware: a model.hpp among them would take the place of its own.
add_library(flight_stacks_crazyflie_core OBJECT "${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src/neural_control_core.cpp")
target_link_libraries(flight_stacks_crazyflie_core PRIVATE pinnquad::pinnquad pinnquad_development)

find_package(Threads REQUIRED) # one test has two
add_executable(test_flight_stacks answers_test.cpp bias_test.cpp cores_test.cpp flights_test.cpp onboard_test.cpp past_test.cpp record_test.cpp steps_test.cpp trust_test.cpp
  px4_module_test.cpp takeover_test.cpp "${PROJECT_SOURCE_DIR}/examples/px4_module/pinnquad_control.cpp"
  crazyflie_firmware_test.cpp
  $<TARGET_OBJECTS:flight_stacks_crazyflie_glue> $<TARGET_OBJECTS:flight_stacks_crazyflie_core> $<TARGET_OBJECTS:test_main>)
target_include_directories(test_flight_stacks PRIVATE ${stack_includes} "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/px4" "${stand_in}/px4"
  "${PROJECT_SOURCE_DIR}/examples/px4_module")
target_compile_definitions(test_flight_stacks PRIVATE PINNQUAD_FLOWN_VEHICLE=0 PINNQUAD_TRUST=0
  "PINNQUAD_PX4_MODULE=\"${PROJECT_SOURCE_DIR}/examples/px4_module\"")
target_link_libraries(test_flight_stacks PRIVATE Threads::Threads)
pinnquad_test_program(test_flight_stacks)
add_test(NAME flight_stacks COMMAND test_flight_stacks)
set_tests_properties(flight_stacks PROPERTIES LABELS flight_stacks TIMEOUT 120 FIXTURES_SETUP crazyflie_log)

# What the Crazyflie's glue wrote to its card, through the same core on the ground.
if(TARGET pinnquad_program)
  add_test(NAME flight_stacks.crazyflie_log
    COMMAND pinnquad_program replay flight_stacks_crazyflie.usd --model flight_stacks_crazyflie.block)
  set_tests_properties(flight_stacks.crazyflie_log PROPERTIES LABELS flight_stacks FIXTURES_REQUIRED crazyflie_log
    PASS_REGULAR_EXPRESSION "same .* 3150 ticks")
endif()

# PX4's module once more, against the branches after v1.16 (px4_module/px4_version.hpp).
add_executable(test_flight_stacks_px4_later px4_module_test.cpp "${PROJECT_SOURCE_DIR}/examples/px4_module/pinnquad_control.cpp"
  $<TARGET_OBJECTS:test_main>)
target_include_directories(test_flight_stacks_px4_later PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/px4_later" "${stand_in}/px4_later" ${stack_includes}
  "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/px4" "${stand_in}/px4" "${PROJECT_SOURCE_DIR}/examples/px4_module")
target_compile_definitions(test_flight_stacks_px4_later PRIVATE PINNQUAD_PX4_MODULE_DESCRIPTOR=1
  PINNQUAD_FLOWN_VEHICLE=1 PINNQUAD_TRUST=0
  "PINNQUAD_PX4_MODULE=\"${PROJECT_SOURCE_DIR}/examples/px4_module\"")
pinnquad_test_program(test_flight_stacks_px4_later)
# with an SD card of its own
file(MAKE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/px4_later.work")
add_test(NAME flight_stacks.px4_later COMMAND test_flight_stacks_px4_later
  WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/px4_later.work")
set_tests_properties(flight_stacks.px4_later PROPERTIES LABELS flight_stacks TIMEOUT 120)
pinnquad_thorough(flight_stacks.px4_later)
pinnquad_thorough_target(test_flight_stacks_px4_later)

# Both glues once more, with a model of a window and of the battery voltage.
add_library(flight_stacks_past_core OBJECT "${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src/neural_control_core.cpp")
target_include_directories(flight_stacks_past_core PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/crazyflie_past" ${stack_includes})
target_link_libraries(flight_stacks_past_core PRIVATE pinnquad::pinnquad pinnquad_development)
add_executable(test_flight_stacks_past past_glue_test.cpp "${PROJECT_SOURCE_DIR}/examples/px4_module/pinnquad_control.cpp"
  $<TARGET_OBJECTS:flight_stacks_crazyflie_glue> $<TARGET_OBJECTS:flight_stacks_past_core> $<TARGET_OBJECTS:test_main>)
target_include_directories(test_flight_stacks_past PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/px4_past" ${stack_includes}
  "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/px4" "${stand_in}/px4" "${PROJECT_SOURCE_DIR}/examples/px4_module")
target_compile_definitions(test_flight_stacks_past PRIVATE PINNQUAD_FLOWN_VEHICLE=0 PINNQUAD_TRUST=0
  "PINNQUAD_PX4_MODULE=\"${PROJECT_SOURCE_DIR}/examples/px4_module\"")
pinnquad_test_program(test_flight_stacks_past)
file(MAKE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/past.work")
add_test(NAME flight_stacks.past COMMAND test_flight_stacks_past WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/past.work")
set_tests_properties(flight_stacks.past PROPERTIES LABELS flight_stacks TIMEOUT 120)
add_test(NAME flight_stacks.crazyflie_refuses.little_app_stack COMMAND "${CMAKE_CXX_COMPILER}" -fsyntax-only -std=c++17
  -DCONFIG_APP_STACKSIZE=600 "-I${PROJECT_SOURCE_DIR}/include" "-I${PROJECT_SOURCE_DIR}/examples"
  "-I${CMAKE_CURRENT_SOURCE_DIR}/crazyflie_past" -isystem "$<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>"
  "${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src/neural_control_core.cpp")
set_tests_properties(flight_stacks.crazyflie_refuses.little_app_stack PROPERTIES LABELS flight_stacks
  PASS_REGULAR_EXPRESSION "raise CONFIG_APP_STACKSIZE to 800")
pinnquad_thorough(flight_stacks.past)
pinnquad_thorough_target(test_flight_stacks_past flight_stacks_past_core)

target_compile_definitions(test_flight_stacks PRIVATE "PINNQUAD_PX4_MESSAGES=\"${PROJECT_SOURCE_DIR}/examples/px4_module/msg\"")

# The module's own CMakeLists.txt and module.yaml, in a stand-in of PX4's build.
foreach(later IN ITEMS OFF ON)
  add_test(NAME flight_stacks.px4_build.later_${later} COMMAND "${CMAKE_COMMAND}" -G Ninja
    -S "${CMAKE_CURRENT_SOURCE_DIR}/px4_build" -B "${CMAKE_CURRENT_BINARY_DIR}/px4_build_${later}" "-DLATER=${later}"
    "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" "-DMODULE_DIR=${PROJECT_SOURCE_DIR}/examples/px4_module"
    -DPX4_PLATFORM=posix)
  set_tests_properties(flight_stacks.px4_build.later_${later} PROPERTIES LABELS flight_stacks)
endforeach()

# What the glue refuses to be built with.
foreach(missing IN ITEMS "WITHOUT_KALMAN:needs the Kalman estimator" "MINIMAL_STACK=100:too little stack"
    "WITHOUT_BATTERY_COMPENSATION:needs CONFIG_ENABLE_THRUST_BAT_COMPENSATED")
  string(REGEX MATCH "^([^:]*):(.*)$" parts "${missing}")
  set(name "flight_stacks.crazyflie_refuses.${CMAKE_MATCH_1}")
  add_test(NAME "${name}" COMMAND "${CMAKE_C_COMPILER}" -fsyntax-only -std=gnu11 "-D${CMAKE_MATCH_1}"
    "-I${crazyflie_headers}" "-I${stand_in}/crazyflie" "-I${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src" "${crazyflie_glue}")
  set_tests_properties("${name}" PROPERTIES LABELS flight_stacks PASS_REGULAR_EXPRESSION "${CMAKE_MATCH_2}")
endforeach()

# The glue of an app that learns its vehicle; its core is compiled by flight_stacks.stack.crazyflie_onboard.
add_test(NAME flight_stacks.crazyflie_glue.onboard COMMAND "${CMAKE_C_COMPILER}" -fsyntax-only -std=gnu11 -Wall -Wextra -Werror
  -DPINNQUAD_ONBOARD "-I${crazyflie_headers}" "-I${stand_in}/crazyflie" "-I${PROJECT_SOURCE_DIR}/examples/crazyflie_app/src" "${crazyflie_glue}")
set_tests_properties(flight_stacks.crazyflie_glue.onboard PROPERTIES LABELS flight_stacks)

# ROS 2's package: its core alone, and its component against a stand-in of rclcpp.
add_executable(test_flight_stacks_ros2 ros2/core_test.cpp ros2/node_test.cpp
  "${PROJECT_SOURCE_DIR}/examples/ros2_package/src/inverse_node.cpp" $<TARGET_OBJECTS:test_main>)
target_include_directories(test_flight_stacks_ros2 PRIVATE ros2 "${stand_in}/ros2" "${PROJECT_SOURCE_DIR}/examples"
  "${PROJECT_SOURCE_DIR}/examples/models")
target_compile_definitions(test_flight_stacks_ros2 PRIVATE "PINNQUAD_ROS2_PACKAGE=\"${PROJECT_SOURCE_DIR}/examples/ros2_package\"")
pinnquad_test_program(test_flight_stacks_ros2)
add_test(NAME flight_stacks.ros2 COMMAND test_flight_stacks_ros2)
set_tests_properties(flight_stacks.ros2 PROPERTIES LABELS flight_stacks)
foreach(model IN ITEMS "${PROJECT_SOURCE_DIR}/examples/models" none)
  get_filename_component(name "${model}" NAME)
  add_test(NAME flight_stacks.ros2_build.${name} COMMAND "${CMAKE_CTEST_COMMAND}"
    --build-and-test "${CMAKE_CURRENT_SOURCE_DIR}/ros2_build" "${CMAKE_CURRENT_BINARY_DIR}/ros2_build_${name}"
    --build-generator "${CMAKE_GENERATOR}" --build-options "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}"
      "-DCMAKE_CXX_FLAGS=-Wall -Wextra ${pinnquad_werror}" "-DPINNQUAD_DIR=${PROJECT_SOURCE_DIR}" "-DPINNQUAD_MODEL_DIR=${model}"
      "-DPACKAGE_DIR=${PROJECT_SOURCE_DIR}/examples/ros2_package" "-DSTAND_IN=${CMAKE_CURRENT_SOURCE_DIR}/ros2;${stand_in}/ros2"
    --test-command true)
  set_tests_properties(flight_stacks.ros2_build.${name} PROPERTIES LABELS flight_stacks)
endforeach()
set_tests_properties(flight_stacks.ros2_build.none PROPERTIES PASS_REGULAR_EXPRESSION "no model.hpp in PINNQUAD_MODEL_DIR")

# Flights as the cores write them down, for `pinnquad replay` (tests/programs/test_replay_log.py).
if(TARGET pinnquad_program)
  add_executable(flight_stacks_record record.cpp)
  target_include_directories(flight_stacks_record PRIVATE ${stack_includes})
  target_link_libraries(flight_stacks_record PRIVATE pinnquad::pinnquad pinnquad_development)
  pinnquad_thorough_target(flight_stacks_record) # what programs.replay_log reads
endif()

# One program, two builds: commands differ by 1e-6 where maths may be rearranged.
foreach(maths IN ITEMS plain unsafe)
  add_executable(flight_stacks_replay_${maths} replay.cpp)
  target_include_directories(flight_stacks_replay_${maths} PRIVATE ${stack_includes})
  target_link_libraries(flight_stacks_replay_${maths} PRIVATE pinnquad::pinnquad pinnquad_development)
  pinnquad_thorough_target(flight_stacks_replay_${maths})
endforeach()
target_compile_options(flight_stacks_replay_unsafe PRIVATE -funsafe-math-optimizations -fno-math-errno)
add_test(NAME flight_stacks.plain_maths COMMAND flight_stacks_replay_plain plain_maths.txt)
add_test(NAME flight_stacks.unsafe_maths COMMAND flight_stacks_replay_unsafe plain_maths.txt 1e-5)
set_tests_properties(flight_stacks.plain_maths PROPERTIES LABELS flight_stacks FIXTURES_SETUP plain_maths)
set_tests_properties(flight_stacks.unsafe_maths PROPERTIES LABELS flight_stacks FIXTURES_REQUIRED plain_maths)
pinnquad_thorough(flight_stacks.plain_maths)
pinnquad_thorough(flight_stacks.unsafe_maths)
