#pragma once

#include <map>
#include <string>
#include <vector>

#include "bag/mcap_format.hpp"
#include "bag/random_file.hpp"

namespace palpate::bag {

/// Position of messages in a file: a chunk's record, or messages outside of chunks.
struct ChunkPlace {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< with the records' heads
  std::uint64_t start = UINT64_MAX;
  std::uint64_t end = 0;
  std::vector<std::uint16_t> channels;  ///< in it; empty: not known
  bool loose = false;                   ///< no chunk
};

struct AttachmentPlace {
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
  std::vector<ChunkPlace> chunks;  ///< as they lie in the file
  std::vector<AttachmentPlace> attachments;
  std::vector<Metadata> metadata;
  std::uint64_t messages = 0;
  std::uint64_t start = UINT64_MAX;  ///< times of the messages; start > end: there are none
  std::uint64_t end = 0;
  bool closed = false;              ///< its end is there and whole
  std::vector<std::string> losses;  ///< what is damaged, in words

  /// The same loss is told once; after the twentieth only that there are more.
  void lose(const std::string& what);
  /// A schema or channel, wherever it was found. @throws Error when the record is damaged.
  void describe(Op op, View content);
};

/// Finds what a file holds: by what its end says, and record by record where that says nothing or
/// is damaged. Holds a chunk at a time. Where a record does not fit, the search goes on behind it;
/// where its length cannot be true, at the next chunk that the file's end knows.
/// @throws Error when it is no MCAP file.
[[nodiscard]] Contents walk(const RandomFile& file);

}  // namespace palpate::bag
