// Holds what the data section of an MCAP file is found to hold, to compare its summary with that.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "bag/mcap_walk.hpp"

namespace palpate::bag {

/// The format leaves records of these kinds and above to others.
inline constexpr std::uint8_t kPrivate = 0x80;

/// A chunk as its record and the message indexes behind it are.
struct ChunkFacts {
  std::uint64_t start = 0;  ///< ns
  std::uint64_t end = 0;    ///< ns
  std::uint64_t length = 0;
  std::uint64_t indexes = 0;                       ///< bytes of the message indexes
  std::map<std::uint16_t, std::uint64_t> offsets;  ///< of the message index of each channel
  std::string compression;
  std::uint64_t packed = 0;  ///< bytes
  std::uint64_t size = 0;    ///< bytes
  bool lost = false;         ///< its records cannot be read
};

struct DataFacts {
  std::map<std::uint64_t, ChunkFacts> chunks;  ///< by offset
  /// What the summary should store of attachments and metadata: contents of their index records.
  std::map<std::pair<Op, std::uint64_t>, Bytes> notes;
  std::map<std::pair<Op, std::uint16_t>, Bytes> descriptions;  ///< schemas and channels
  std::map<std::uint16_t, std::uint64_t> counts;               ///< messages of each channel
  std::uint64_t messages = 0;
  std::uint64_t start = UINT64_MAX;  ///< ns
  std::uint64_t end = 0;             ///< ns
  bool whole = true;                 ///< no chunk is lost
};

/// A schema or channel with its words in order, so that equal ones are equal bytes.
[[nodiscard]] Bytes description_of(Op op, View content);

/// Adds a loss where there is none: an earlier one may be of the same cause, and more precise.
inline void lose_first(Contents& contents, const std::string& what) {
  if (contents.losses.empty()) contents.lose(what);
}

/// Adds a loss where `stored` is not what was `found`.
template <class Stored, class Found>
void compare(Contents& contents, std::string_view where, std::string_view what,
             const Stored& stored, const Found& found) {
  if (stored == found) return;
  contents.lose(fmt::format("{}: it says {} {}, and {} is there", where, what, stored, found));
}

/// The part of a file behind its data.
struct SummaryPart {
  std::uint64_t at = 0;  ///< byte of the file where it begins
  View records;
  std::uint64_t offsets = 0;  ///< byte of the file where the summary's offsets should begin
};

/// @throws Error at a record that does not fit.
void compare_summary(const SummaryPart& summary, const DataFacts& data, Contents& contents);

}  // namespace palpate::bag
