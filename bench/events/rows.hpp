#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "events/event.hpp"

namespace palpate::events {

/// One kind of event; a seed says which one.
struct Row {
  std::string name;
  std::function<Event(std::uint64_t)> make;
};

[[nodiscard]] std::vector<Row> all_rows();
/// What is thin, slanted or has a rim, as families of sensors see it.
[[nodiscard]] std::vector<Row> sensor_rows();
/// What touches, hides and passes close by, and other sensors, rates and views.
[[nodiscard]] std::vector<Row> hostile_rows();
/// A sensor is at fault where a hand presses.
[[nodiscard]] std::vector<Row> fault_rows();

}  // namespace palpate::events
