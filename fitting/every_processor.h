// SPDX-License-Identifier: MIT
// For sources compiled with options of their own (fitting/CMakeLists.txt): nothing may be fused, so
// that every instruction set gives the same bits.
#pragma once

/// Before a function: compiled for AVX2 too, and chosen by the processor. What it calls has to be
/// SHEEN_INLINE to be compiled with it. Copies are chosen while the program is loaded, when
/// ThreadSanitizer has not started yet.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_THREAD__)
#define SHEEN_FOR_EVERY_PROCESSOR __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define SHEEN_FOR_EVERY_PROCESSOR
#endif
#define SHEEN_INLINE __attribute__((always_inline)) inline
/// Behind the parameters of a lambda: the same for it.
#define SHEEN_INLINE_LAMBDA __attribute__((always_inline))
