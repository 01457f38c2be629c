// SPDX-License-Identifier: MIT
// Ctrl-C as a wish: a program's main catches it once. Long work looks at it, stops by an exception in good order, and
// keeps what is finished. A second Ctrl-C ends at once.
#pragma once

#include <atomic>
#include <csignal>
#include <string>

namespace programs {

constexpr int exit_interrupted = 130;

namespace detail {
inline std::atomic<bool> interrupt_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
extern "C" inline void on_interrupt(int signal) {
  interrupt_wanted.store(true);
  std::signal(signal, SIG_DFL);
}
}  // namespace detail

/// Ends an interrupted command: run_program makes it one line and exit_interrupted. It is no std::exception, so that no
/// handler of refusals takes it.
struct Interrupted {
  std::string kept = "nothing was written";  ///< and how to go on
};

/// From here on the first Ctrl-C, kill or end of the terminal only sets a flag. The last is ignored under nohup, and
/// stays so.
inline void catch_interrupt() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, detail::on_interrupt) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  }
}

inline bool interrupted() { return detail::interrupt_wanted.load(); }

/// Long work calls it between two steps; ProgressLine::update() does.
inline void stop_if_interrupted() {
  if (interrupted()) throw Interrupted{};
}

/// Does `work`; where that is interrupted, the command's line says that `kept` is kept.
template <class Work>
auto keeping(const std::string& kept, const Work& work) {
  try {
    return work();
  } catch (const Interrupted&) {
    throw Interrupted{kept};
  }
}

}  // namespace programs
