// SPDX-License-Identifier: MIT
// From reset to board_main() on a Cortex-M under QEMU: FPU on, data copied, its result as QEMU's exit code. Nothing is
// initialised by constructors: flight code has none to run.
#include <cstdint>

extern "C" {

extern std::uint32_t board_stack_top, board_data_image, board_data_begin, board_data_end, board_bss_begin,
    board_bss_end;

int board_main();
[[noreturn]] void board_reset();

[[noreturn]] static void leave(std::uint32_t code) {
  const std::uint32_t block[2] = {0x20026, code};         // ADP_Stopped_ApplicationExit
  register std::uint32_t operation __asm__("r0") = 0x20;  // SYS_EXIT_EXTENDED
  register const std::uint32_t* argument __asm__("r1") = block;
  for (;;) __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
}

[[noreturn]] static void fault() { leave(99); }

using Handler = void (*)();
struct Vectors {
  std::uint32_t* stack;
  Handler handlers[15];
};
__attribute__((section(".vectors"), used))
const Vectors board_vectors = {&board_stack_top,
                               {board_reset, fault, fault, fault, fault, fault, nullptr, nullptr, nullptr, nullptr,
                                fault, fault, nullptr, fault, fault}};

void board_reset() {
  *reinterpret_cast<volatile std::uint32_t*>(0xe000ed88u) |= 0xfu << 20;  // CPACR: full access to the FPU
  __asm__ volatile("dsb\n isb" ::: "memory");
  const std::uint32_t* from = &board_data_image;
  for (std::uint32_t* to = &board_data_begin; to < &board_data_end;) *to++ = *from++;
  for (std::uint32_t* to = &board_bss_begin; to < &board_bss_end;) *to++ = 0;
  leave(static_cast<std::uint32_t>(board_main()));
}

// Functions that a C library asks for when a test's planted fault pulls it in; such a test has failed anyway.
void _exit(int code) { leave(static_cast<std::uint32_t>(code)); }

}  // extern "C"
