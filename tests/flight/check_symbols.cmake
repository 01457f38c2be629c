# SPDX-License-Identifier: MIT
#
# Compiles SOURCE to OBJECT with FLAGS as firmware would, and rejects it when nm shows a symbol that does not fly.
cmake_minimum_required(VERSION 3.22)

separate_arguments(flags NATIVE_COMMAND "${FLAGS}")
execute_process(
  COMMAND "${COMPILER}" -std=c++17 ${flags} -UNDEBUG -fno-exceptions -fno-rtti
    -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow
    "-I${INCLUDE_DIR}" -isystem "${EIGEN_INCLUDE_DIR}" -c "${SOURCE}" -o "${OBJECT}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT code EQUAL 0)
  message("${output}")
  message(FATAL_ERROR "${SOURCE} does not compile as flight code (${FLAGS})")
endif()

# Mangled and demangled: nm -C renames _GLOBAL__sub_I_x to "global constructors keyed to x".
execute_process(COMMAND "${NM}" "${OBJECT}" RESULT_VARIABLE code OUTPUT_VARIABLE mangled)
execute_process(COMMAND "${NM}" -C "${OBJECT}" RESULT_VARIABLE code_demangled OUTPUT_VARIABLE demangled)
if(NOT code EQUAL 0 OR NOT code_demangled EQUAL 0)
  message(FATAL_ERROR "${NM} can't read ${OBJECT}")
endif()
if(NOT mangled MATCHES " T pinnquad_flight_")
  message(FATAL_ERROR "${SOURCE} defines no function extern \"C\" pinnquad_flight_...: nothing would be looked at")
endif()

# name and regular expression in turn; each line of nm is "<address> <type> <symbol>"
set(offences
  "operator new" " operator new"
  "operator delete" " operator delete"
  "__cxa_guard" " (__cxa_guard|guard variable for )"
  "__cxa_ (exceptions, destructors at exit)" " __cxa_(throw|rethrow|allocate|begin|end|bad|atexit|thread_atexit|pure|deleted)"
  "unwinding" " (_Unwind_|__gxx_personality)"
  "malloc" " (malloc|calloc|realloc|free|cfree|posix_memalign|aligned_alloc|memalign|strdup)(@|\n)"
  "initialised at run time" " (_GLOBAL__sub_I|_GLOBAL__I_|__cxx_global_var_init|global constructors keyed)"
  "vtable or type information" " (vtable|typeinfo|typeinfo name|VTT) for "
  "__dynamic_cast" " __dynamic_cast"
  "iostream" "(ostream|istream|iostream|streambuf|ios_base|std::cout|std::cerr|std::clog)"
  "what the standard library throws" " std::(__throw_|terminate|__glibcxx_assert)"
  "std::string" "(std::string|basic_string<)"
  "printing" " (v?[fs]?n?printf|puts|putchar|fwrite|__printf_chk|__fprintf_chk)(@|\n)"
  "__assert" " (__assert|__assert_fail|__assert_func|__assert_rtn)"
  "abort" " (abort|exit|_exit|quick_exit)(@|\n)"
  "thread-local storage" " (__tls_get_addr|__emutls_|TLS (init|wrapper) function)")

set(rejected 0)
while(offences)
  list(POP_FRONT offences name pattern)
  if("${mangled}\n${demangled}" MATCHES "[^\n]*${pattern}[^\n]*")
    string(STRIP "${CMAKE_MATCH_0}" line)
    message("rejected: ${name}: ${line}")
    math(EXPR rejected "${rejected} + 1")
  endif()
endwhile()
if(rejected GREATER 0)
  message(FATAL_ERROR "${SOURCE} (${FLAGS}) has symbols that do not fly")
endif()
