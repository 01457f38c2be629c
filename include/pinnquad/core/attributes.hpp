// SPDX-License-Identifier: MIT
// Compiler attributes that flight code needs and C++17 has no word for.
#pragma once

/// Inlines a function whatever the optimiser thinks: prediction kernels must not be emitted out of line, where the linker
/// could pick a copy compiled for another instruction set.
/// Sanitizers, and a program that defines PINNQUAD_INLINE_AS_COMPILER_LIKES in all its units, are left to inline as they like:
/// instrumented or unoptimised kernels inlined by force take minutes to compile.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(PINNQUAD_INLINE_AS_COMPILER_LIKES)
#define PINNQUAD_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define PINNQUAD_ALWAYS_INLINE inline
#endif

/// The same for a lambda: `[&](auto i) PINNQUAD_INLINE_LAMBDA { ... }`.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(__SANITIZE_ADDRESS__)
#define PINNQUAD_INLINE_LAMBDA __attribute__((always_inline))
#else
#define PINNQUAD_INLINE_LAMBDA
#endif

/// Keeps a function out of line: where its code would cost a hot caller registers.
#if defined(__GNUC__) || defined(__clang__)
#define PINNQUAD_NOINLINE __attribute__((noinline))
#else
#define PINNQUAD_NOINLINE
#endif

/// Inlines all that a function calls: for a hot function made of many small ones.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(__SANITIZE_ADDRESS__)
#define PINNQUAD_FLATTEN __attribute__((flatten))
#else
#define PINNQUAD_FLATTEN
#endif

/// Makes the compiler forget where a pointer points: what stands there is read anew where it is used, instead of being kept, on
/// the stack where there are too few registers.
#if defined(__GNUC__) || defined(__clang__)
#define PINNQUAD_FORGET(pointer) __asm__("" : "+r"(pointer))
#else
#define PINNQUAD_FORGET(pointer) static_cast<void>(pointer)
#endif
