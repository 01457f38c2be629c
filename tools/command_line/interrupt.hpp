// SPDX-License-Identifier: MIT
// Ctrl-C as a wish: long work looks at it, stops in good order and keeps what is finished. A second Ctrl-C ends at
// once.
#pragma once

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace programs {

constexpr int exit_interrupted = 130;

namespace detail {
inline std::atomic<bool> interrupt_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
extern "C" inline void on_interrupt(int signal) {
  interrupt_wanted.store(true);
  std::signal(signal, SIG_DFL);
}
extern "C" inline void end_interrupted(int /*signal*/) { ::_exit(exit_interrupted); }

/// Ctrl-C, kill, and the end of the terminal; the last is ignored under nohup, and stays so.
inline void at_interrupt(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, handler) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  }
}
}  // namespace detail

/// From here on Ctrl-C (SIGTERM, SIGHUP) ends the program with exit_interrupted, at once: for what writes nothing that
/// could be half there.
inline void end_at_interrupt() { detail::at_interrupt(detail::end_interrupted); }

/// From here on the first Ctrl-C (SIGTERM, SIGHUP) only sets a flag.
inline void catch_interrupt() { detail::at_interrupt(detail::on_interrupt); }

inline bool interrupted() { return detail::interrupt_wanted.load(); }

}  // namespace programs
