// Reports how far work is that threads do side by side, and ends all of it together.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <utility>

#include "base/progress.hpp"

namespace palpate {

/// How far blocks are that are prepared side by side; what ends one ends all.
class SharedProgress {
 public:
  /// `points`: of all blocks.
  SharedProgress(const detail::Progress& progress, std::size_t points)
      : progress_(progress), points_(static_cast<double>(points)) {}

  /// Prepares a block of so many points: calls work(progress of the block), unless all has ended.
  /// What that throws stays here until end(): in a parallel loop it would leave other blocks in
  /// their middle.
  template <class Work>
  void run(std::size_t points, const Work& work) {
    double told = 0;
    const auto progress = [&](double share) {
      const double now = share * static_cast<double>(points);
      add(now - std::exchange(told, now));
    };
    try {
      progress(0);
      work(progress);
      progress(1);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      end_by_error();
    }
  }

  /// @throws what ended a block first.
  void end() {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  struct Ended {};

  // Nobody waits for another thread that is telling.
  void add(double points) {
    if (ended_) throw Ended();
    done_ += points;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || ended_) return;
    try {
      detail::tell(progress_, std::min(1., done_ / points_));
    } catch (...) {
      end_by_error();  // before another thread can lock, and tell once more
      throw;
    }
  }

  /// With the lock, in a handler.
  void end_by_error() {
    if (!ended_.exchange(true)) error_ = std::current_exception();
  }

  const detail::Progress& progress_;
  double points_;
  std::atomic<double> done_ = 0;  // points
  std::atomic<bool> ended_ = false;
  std::mutex mutex_;  // of those who tell, and of `error_`
  std::exception_ptr error_;
};

}  // namespace palpate
