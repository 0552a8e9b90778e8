#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <thread>

namespace palpate::python {

/// Stays here where the interpreter has ended: its threads' states are gone, too.
inline void stay_if_ended() {
  while (Py_IsInitialized() == 0) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Lets other threads of Python go on until its end, where it waits for the GIL. A thread that
/// comes back after the interpreter has ended stays here: Python itself keeps such threads from
/// 3.14 on, and ends them before by an exception that no destructor lets pass.
class Released {
 public:
  Released() : ends_(Py_IsInitialized() == 0), thread_(PyEval_SaveThread()) {}
  ~Released() {
    if (!ends_) stay_if_ended();
    try {
      PyEval_RestoreThread(thread_);
    } catch (...) {
      for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
    }
  }
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

 private:
  bool ends_;  // the interpreter, which destroys what is left on this thread
  PyThreadState* thread_;
};

/// Ticks or samples between two looks for signals; judgement.
inline constexpr std::size_t kUninterrupted = 1 << 16;

/// The thread that imported the module, as the main one does: handlers of signals run in no other.
inline const std::thread::id kMainThread = std::this_thread::get_id();

/// Lets Python's handlers of signals run: Ctrl-C throws KeyboardInterrupt. For a thread that is
/// Released.
inline void hear_signals() {
  stay_if_ended();
  if (std::this_thread::get_id() != kMainThread) return;
  const pybind11::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

/// Lets long work hear signals, which calls this with the share that is done.
[[nodiscard]] inline std::function<void(double share)> hearing() {
  using Clock = std::chrono::steady_clock;
  static constexpr auto kPatience = std::chrono::milliseconds(100);  // no wait is felt (judgement)
  return [next = Clock::now() + kPatience](double /*share*/) mutable {
    if (std::this_thread::get_id() != kMainThread || Clock::now() < next) return;
    next = Clock::now() + kPatience;
    hear_signals();
  };
}

}  // namespace palpate::python
