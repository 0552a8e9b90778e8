// Holds what the end of an MCAP file contains.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "bag/mcap_format.hpp"

namespace palpate::bag {

/// All that a reader needs of a file without reading its data, while it grows.
struct McapSummary {
  struct ChannelState {
    Channel channel;
    std::uint16_t schema = 0;
    std::uint64_t since = UINT64_MAX;  // the chunk that holds it
    std::uint32_t sequence = 0;
    // Log times and offsets of messages in the growing chunk.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;
  };

  /// Sums over the file so far; `indexed`: lengths of `index`, bytes.
  struct Totals {
    std::uint64_t messages = 0;
    std::uint64_t start = UINT64_MAX;
    std::uint64_t end = 0;
    std::uint32_t crc = 0;  // of all bytes
    std::uint32_t chunks = 0;
    std::uint32_t attachments = 0;
    std::uint32_t metadata = 0;
    std::vector<std::uint64_t> counts;  // of each channel
    std::array<std::size_t, 3> indexed{};
  };

  std::vector<Schema> schemas;         // the first is number 1
  std::vector<ChannelState> channels;  // as well
  Totals totals;
  std::array<Bytes, 3> index;  // records of chunks, attachments, metadata

  /// The channel's number.
  std::uint16_t add(const Channel& channel);

  /// Writes what a reader needs of a channel before its first message, which comes now.
  void describe(Bytes& out, std::uint16_t number);

  /// The end of a file with these totals whose data end at byte `at`.
  [[nodiscard]] Bytes ending(const Totals& after, std::uint64_t at) const;
};

}  // namespace palpate::bag
