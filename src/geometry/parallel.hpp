#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace palpate::detail {

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

}  // namespace palpate::detail
