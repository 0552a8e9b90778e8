#pragma once

// What runs side by side, by TBB. Only extras/tile/in_order.hpp uses TBB as well. PALPATE_SERIAL,
// as a machine without threads has it: one thread does all in turn, with the same results.
#ifndef PALPATE_SERIAL
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_sort.h>
#include <oneapi/tbb/task_arena.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

#ifdef PALPATE_SERIAL

template <class Body>
void parallel_ranges(std::size_t count, std::size_t /*grain*/, const Body& body) {
  if (count > 0) body(std::size_t{0}, count);
}
template <class Iterator>
void parallel_sort(Iterator begin, Iterator end) {
  std::sort(begin, end);
}
template <class First, class Second>
void parallel_pair(const First& first, const Second& second) {
  first();
  second();
}
template <class Work>
void isolated(const Work& work) {
  work();
}
class Background {
 public:
  template <class Work>
  void run(const Work& work) {
    work();
  }
};

#else

/// Calls body(begin, end) for pieces of [0, count), on several threads when there is more than one
/// piece of `grain`. Bodies write what belongs to their piece and nothing else, so results do not
/// depend on the number of threads.
template <class Body>
void parallel_ranges(std::size_t count, std::size_t grain, const Body& body) {
  if (count <= grain) {
    if (count > 0) body(std::size_t{0}, count);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const auto& range) { body(range.begin(), range.end()); });
}

/// Sorts. Where no two are equal, the order does not depend on the number of threads.
template <class Iterator>
void parallel_sort(Iterator begin, Iterator end) {
  tbb::parallel_sort(begin, end);
}

/// Calls both, side by side where there are threads for it.
template <class First, class Second>
void parallel_pair(const First& first, const Second& second) {
  tbb::parallel_invoke(first, second);
}

/// Calls work(). While this thread waits for parts of it, it begins nothing else.
template <class Work>
void isolated(const Work& work) {
  tbb::this_task_arena::isolate(work);
}

/// All cores but one: that is the servos'.
class Background {
 public:
  template <class Work>
  void run(const Work& work) {
    arena_.execute(work);
  }

 private:
  tbb::task_arena arena_{std::max(1, tbb::this_task_arena::max_concurrency() - 1)};
};

#endif

/// Calls body(i) for each of [0, count) likewise.
template <class Body>
void parallel_each(std::size_t count, std::size_t grain, const Body& body) {
  parallel_ranges(count, grain, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) body(i);
  });
}

/// Calls body(i, memory): each piece has a `Memory`, which keeps its room from one i to the next.
template <class Memory, class Body>
void parallel_each_with(std::size_t count, std::size_t grain, const Body& body) {
  parallel_ranges(count, grain, [&](std::size_t i, std::size_t end) {
    Memory memory;
    for (; i < end; ++i) body(i, memory);
  });
}

/// A position on a Morton curve through cells numbered along each axis, of which the lower 11 bits
/// count.
inline std::uint64_t morton_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  // Puts two zero bits between any two.
  const auto spread = [](std::uint64_t v) {
    v = (v | (v << 16)) & 0x70000FF;
    v = (v | (v << 8)) & 0x700F00F;
    v = (v | (v << 4)) & 0x430C30C3;
    v = (v | (v << 2)) & 0x49249249;
    return v;
  };
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

/// A Morton key and the index of its point in the input, in one word: sorting words sorts by key,
/// and by index among equal keys.
using Record = std::uint64_t;

inline constexpr int kIndexBits = 31;  ///< what a key leaves of 64 bits
inline constexpr int kKeyBits = 33;    ///< eleven levels of three bits (judgement)
inline constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << kIndexBits) - 1;  ///< the index

/// Sorts records by the upper `bits` of their kKeyBits key; equal keys keep their order. `scratch`
/// is as long as `records`. Runs on several threads when there are many records; the result does
/// not depend on their number.
void sort_records(std::span<Record> records, std::span<Record> scratch, int bits);

}  // namespace palpate::detail
