// Declares a loop whose bodies run side by side and whose results come in order.
#pragma once

#include <oneapi/tbb/parallel_pipeline.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace palpate::io::tile {

/// Calls make(i) for each of [0, count) on all cores, at most `ahead` of them at a time, and take()
/// with what each gave: in their order, never two at once. Whatever either throws ends it.
template <class Make, class Take>
void in_order(std::size_t count, std::size_t ahead, const Make& make, const Take& take) {
  // A number's slot is free again when the one `ahead` of it has been taken.
  std::vector<std::optional<decltype(make(std::size_t{}))>> slots(ahead);
  std::size_t next = 0;
  const auto number = [&](tbb::flow_control& flow) {
    if (next == count) flow.stop();
    return next == count ? count : next++;
  };
  const auto one = [&](std::size_t i) {
    slots[i % ahead].emplace(make(i));
    return i;
  };
  const auto last = [&](std::size_t i) {
    take(*slots[i % ahead]);
    slots[i % ahead].reset();
  };
  constexpr auto kOrdered = tbb::filter_mode::serial_in_order;
  tbb::parallel_pipeline(
      ahead, tbb::make_filter<void, std::size_t>(kOrdered, number) &
                 tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, one) &
                 tbb::make_filter<std::size_t, void>(kOrdered, last));
}

}  // namespace palpate::io::tile
