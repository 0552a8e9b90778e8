#pragma once

#ifndef PALPATE_SERIAL
#include <oneapi/tbb/global_control.h>
#endif

#include <cstddef>

namespace palpate {

/// While it lives, at most so many threads compute side by side. A build without threads (a tab's)
/// has one anyway.
class ThreadLimit {
 public:
#ifdef PALPATE_SERIAL
  explicit ThreadLimit(std::size_t /*threads*/) {}
#else
  explicit ThreadLimit(std::size_t threads)
      : limit_(tbb::global_control::max_allowed_parallelism, threads) {}

 private:
  tbb::global_control limit_;
#endif
};

}  // namespace palpate
