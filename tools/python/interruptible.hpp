// SPDX-License-Identifier: MIT
// Work of the program's rooms, called from Python: without the GIL, ended by Ctrl-C in good order.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <thread>

#include "command_line/interrupt.hpp"
#include "python/bindings.hpp"

namespace python {

/// Calls `work` on a thread of its own. What a signal's handler raises, as Ctrl-C's KeyboardInterrupt, makes
/// programs::interrupted() true, which `work` looks at, and goes on when `work` is back. One at a time: RuntimeError
/// where another thread's is at work.
inline void run_interruptible(const std::function<void()>& work) {
  static bool busy = false;
  if (busy) throw std::runtime_error("another thread trains, identifies or certifies: one at a time");
  const Busy mine(busy);
  std::exception_ptr failure, raised;
  std::atomic<bool> done{false};
  {
    const py::gil_scoped_release without_gil;
    std::thread thread([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
      }
      done.store(true);
    });
    while (!done.load()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (raised) continue;
      const py::gil_scoped_acquire with_gil;
      if (PyErr_CheckSignals() == 0) continue;
      raised = std::make_exception_ptr(py::error_already_set());
      programs::detail::interrupt_wanted.store(true);
    }
    thread.join();
  }
  programs::detail::interrupt_wanted.store(false);
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace python
