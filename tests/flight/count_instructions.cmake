# SPDX-License-Identifier: MIT
#
# Compiles each case of SOURCE and counts the instructions of the whole object file: a vehicle without effects must not have
# more than the bare equations, and each effect must add some (or the count proves nothing).
cmake_minimum_required(VERSION 3.22)

separate_arguments(flags UNIX_COMMAND "${FLAGS}")

# count(<case> <variable>)
function(count case variable)
  execute_process(
    COMMAND "${COMPILER}" -std=c++17 ${flags} -fno-exceptions -fno-rtti -DNDEBUG "-D${case}" "-I${INCLUDE_DIR}"
      -isystem "${EIGEN_INCLUDE_DIR}" -c "${SOURCE}" -o "${OBJECT}"
    RESULT_VARIABLE code ERROR_VARIABLE errors)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${case} does not compile: ${errors}")
  endif()
  execute_process(COMMAND "${OBJDUMP}" -d --no-show-raw-insn "${OBJECT}" OUTPUT_VARIABLE assembly RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "objdump failed")
  endif()
  string(REGEX MATCHALL "\n +[0-9a-f]+:[ \t]+[a-z]+" instructions "${assembly}")
  list(FILTER instructions EXCLUDE REGEX "[ \t](nop|xchg|data|cs)")
  list(LENGTH instructions number)
  if(number LESS 80)
    message(FATAL_ERROR "${case}: only ${number} instructions: not counted rightly")
  endif()
  message(STATUS "${case}: ${number} instructions")
  set(${variable} ${number} PARENT_SCOPE)
endfunction()

count(EQUATIONS_ALONE bare)
count(WITHOUT_EFFECTS none)
count(WITH_DRAG drag)
count(WITH_DRAG_AND_DENSITY both)
# a call, and the time and density that the vehicle hands out
math(EXPR most "${bare} + 25")
if(none GREATER most)
  message(FATAL_ERROR "a vehicle without effects takes ${none} instructions, the equations alone ${bare}")
endif()
if(NOT drag GREATER none OR NOT both GREATER drag)
  message(FATAL_ERROR "an effect adds no instruction: the count is not to be trusted")
endif()
