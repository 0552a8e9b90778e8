#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
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

}  // namespace palpate::python
