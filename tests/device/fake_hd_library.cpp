#include "device/fake_hd_library.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace palpate::test {

FakeHdLibrary& fake_hd_library() {
  static FakeHdLibrary only;
  return only;
}

void FakeHdLibrary::run(const std::stop_token& stop) {
  Lock lock(mutex);
  const auto is_due = [this] { return granted > 0 || runs_by_itself; };
  while (changed.wait(lock, stop, is_due) && !stop.stop_requested()) {
    const bool is_granted = granted > 0;
    is_ticking = true;
    tick(lock);
    is_ticking = false;
    if (is_granted) --granted;
    changed.notify_all();
    changed.wait_for(lock, stop, std::chrono::duration<double>(faults.pause),
                     [this] { return !runs_by_itself; });
  }
}

void FakeHdLibrary::tick(Lock& lock) {
  std::vector<Task> called = std::exchange(tasks, {});
  lock.unlock();
  std::erase_if(called, [](const Task& each) { return each.callback(each.data) == 0; });
  lock.lock();
  tasks.insert(tasks.begin(), called.begin(), called.end());
  for (Device& each : devices) each.hand.advance(kTick, each.held);
}

void FakeHdLibrary::take_time(Lock& lock, const Device& device) {
  const auto note_forces = [&] {
    disturbances += static_cast<int>(std::ranges::count_if(
        devices, [&](const Device& each) { return &each != &device && each.held != Three{}; }));
  };
  is_busy = true;
  note_forces();
  changed.wait_for(lock, std::chrono::duration<double>(faults.opening), [] { return false; });
  note_forces();
  is_busy = false;
}

FakeHdLibrary::Lock FakeHdLibrary::heard() {
  Lock lock(mutex);
  if (is_busy) ++disturbances;
  return lock;
}

}  // namespace palpate::test
