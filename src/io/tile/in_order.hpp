// Declares a loop whose bodies run side by side and whose results come in order.
#pragma once

#include <oneapi/tbb/parallel_pipeline.h>

#include <cstddef>
#include <memory>

namespace palpate::io::tile {

/// Calls make(i) for each of [0, count) on all cores, at most `ahead` of them at a time, and take()
/// with what each gave: in their order, never two at once. Whatever either throws ends it.
template <class Make, class Take>
void in_order(std::size_t count, std::size_t ahead, const Make& make, const Take& take) {
  using Made = std::shared_ptr<decltype(make(std::size_t{}))>;
  std::size_t next = 0;
  const auto number = [&](tbb::flow_control& flow) {
    if (next == count) flow.stop();
    return next == count ? count : next++;
  };
  const auto one = [&](std::size_t i) {
    return std::make_shared<typename Made::element_type>(make(i));
  };
  constexpr auto kOrdered = tbb::filter_mode::serial_in_order;
  tbb::parallel_pipeline(
      ahead, tbb::make_filter<void, std::size_t>(kOrdered, number) &
                 tbb::make_filter<std::size_t, Made>(tbb::filter_mode::parallel, one) &
                 tbb::make_filter<Made, void>(kOrdered, [&](const Made& made) { take(*made); }));
}

}  // namespace palpate::io::tile
