#include "scene/policies/block_entries.hpp"

#include <algorithm>

namespace palpate {

void BlockEntries::sort(std::span<const Entry> entries, std::size_t blocks) {
  begin_.resize(blocks + 2);
  std::fill(begin_.begin(), begin_.end(), 0u);
  for (const Entry& entry : entries) ++begin_[entry.place + 2];
  for (std::size_t place = 2; place < begin_.size(); ++place) begin_[place] += begin_[place - 1];
  sorted_.resize(entries.size());
  // begin_[place + 1] runs from where the place's entries begin to where they end.
  for (std::size_t i = 0; i < entries.size(); ++i) {
    sorted_[begin_[entries[i].place + 1]++] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace palpate
