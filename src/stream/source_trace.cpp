// Reads and imposes what a source depended on, for recordings and replays.
#include "stream/source_trace.hpp"

#include <algorithm>

#include "stream/streaming.hpp"

namespace palpate {

std::span<const Reach> SourceTrace::reach() const {
  return Streaming::of(*source_).found;
}

std::uint64_t SourceTrace::publications() const {
  return source_->inside_->publications;
}

std::uint64_t SourceTrace::changes() const {
  return Streaming::of(*source_).changes;
}

const SourceOptions& SourceTrace::options() const {
  return Streaming::of(*source_).taken;
}

void SourceTrace::impose_reach(std::span<const Reach> reach) {
  ReachTable& table = source_->inside_->reaches;
  for (std::size_t i = 0; i < ReachTable::kSlots; ++i) {
    if (i < reach.size()) {
      table.write(i, reach[i]);
    } else {
      table.clear(i);
    }
  }
}

void SourceTrace::impose_least_radius(double radius) {
  source_->inside_->slot.seams->set_least_radius(source_->inside_->slot.number, radius);
}

}  // namespace palpate
