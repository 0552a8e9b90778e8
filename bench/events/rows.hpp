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

}  // namespace palpate::events
