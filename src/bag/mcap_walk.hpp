#pragma once

#include <map>
#include <string>
#include <vector>

#include "bag/mcap_format.hpp"
#include "bag/random_file.hpp"

namespace palpate::bag {

/// Bytes and times of messages in a file: a chunk's record, or messages outside of chunks.
struct ChunkSpan {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< with the records' heads
  std::uint64_t start = UINT64_MAX;
  std::uint64_t end = 0;
  std::vector<std::uint16_t> channels;  ///< in it; empty: unknown
  bool loose = false;                   ///< no chunk
};

struct AttachmentSpan {
  Attachment head;           ///< without its data
  std::uint64_t offset = 0;  ///< of the record's content
  std::uint64_t length = 0;
  std::uint64_t size = 0;  ///< of its data, bytes
};

/// Contents of a file, as its records describe them.
struct Contents {
  std::string profile;
  std::string library;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkSpan> chunks;  ///< as they lie in the file
  std::vector<AttachmentSpan> attachments;
  std::vector<Metadata> metadata;
  std::uint64_t messages = 0;
  std::uint64_t start = UINT64_MAX;  ///< times of the messages; start > end: there are none
  std::uint64_t end = 0;
  bool closed = false;              ///< its end is there and whole
  std::vector<std::string> losses;  ///< what is damaged, in words

  /// The same loss is reported once; after the twentieth only that there are more.
  void lose(const std::string& what);
  /// A schema or channel, wherever it was found. @throws Error when the record is damaged.
  void describe(Op op, View content);
};

/// Finds what a file holds: by what its end stores, and record by record where that is empty or
/// damaged. Holds a chunk at a time. Where a record does not fit, the search goes on behind it;
/// where its length cannot be true, at the next chunk that the file's end lists.
/// @throws Error when it is no MCAP file.
[[nodiscard]] Contents walk(const RandomFile& file);

}  // namespace palpate::bag
