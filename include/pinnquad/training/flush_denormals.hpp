// SPDX-License-Identifier: MIT
// Denormal numbers count as zero while this lives.
// Weight decay drives the weights of a dead neuron and their moments below 1e-38. An operation on such a number costs a
// hundred ordinary ones, in training and in every prediction.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace pinnquad {

/// Sets flush-to-zero and denormals-are-zero on this thread, and restores what was set before. x86-64 and aarch64;
/// elsewhere it does nothing.
class FlushDenormals {
 public:
  FlushDenormals() noexcept : saved_(control()) { set_control(saved_ | flush_bits); }
  ~FlushDenormals() { set_control(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__SSE2__)
  using Control = unsigned;
  static constexpr Control flush_bits = 0x8040;  // MXCSR: flush to zero, denormals are zero
  static Control control() noexcept { return _mm_getcsr(); }
  static void set_control(Control value) noexcept { _mm_setcsr(value); }
#elif defined(__aarch64__)
  using Control = std::uint64_t;
  static constexpr Control flush_bits = Control{1} << 24;  // FPCR: FZ
  static Control control() noexcept {
    Control value = 0;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return value;
  }
  static void set_control(Control value) noexcept { __asm__ volatile("msr fpcr, %0" : : "r"(value)); }
#else
  using Control = unsigned;
  static constexpr Control flush_bits = 0;
  static Control control() noexcept { return 0; }
  static void set_control(Control) noexcept {}
#endif

  Control saved_;
};

}  // namespace pinnquad
