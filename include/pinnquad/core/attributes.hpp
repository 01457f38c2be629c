// SPDX-License-Identifier: MIT
// Compiler attributes that flight code needs and C++17 has no word for.
#pragma once

/// ALWAYS_INLINE: prediction kernels must not be emitted out of line, where the linker could take a copy compiled for
/// another instruction set. Sanitizers, and a program that defines PINNQUAD_INLINE_AS_COMPILER_LIKES in all its units,
/// inline as they like: instrumented or unoptimised kernels inlined by force take minutes to compile.
/// INLINE_LAMBDA: the same for a lambda, `[&](auto i) PINNQUAD_INLINE_LAMBDA { ... }`.
/// NOINLINE: for code that would cost a hot caller registers.
/// FLATTEN: inlines all that a function calls, for a hot function made of many small ones.
/// FORGET(pointer): the values it points to are read anew where they are used, not kept on the stack.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(__SANITIZE_ADDRESS__)
#define PINNQUAD_INLINE_LAMBDA __attribute__((always_inline))
#define PINNQUAD_FLATTEN __attribute__((flatten))
#else
#define PINNQUAD_INLINE_LAMBDA
#define PINNQUAD_FLATTEN
#endif
#if (defined(__GNUC__) || defined(__clang__)) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(PINNQUAD_INLINE_AS_COMPILER_LIKES)
#define PINNQUAD_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define PINNQUAD_ALWAYS_INLINE inline
#endif
#if defined(__GNUC__) || defined(__clang__)
#define PINNQUAD_NOINLINE __attribute__((noinline))
#define PINNQUAD_FORGET(pointer) __asm__("" : "+r"(pointer))
#else
#define PINNQUAD_NOINLINE
#define PINNQUAD_FORGET(pointer) static_cast<void>(pointer)
#endif
