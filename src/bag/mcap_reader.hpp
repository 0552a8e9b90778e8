#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bag/mcap_walk.hpp"

namespace palpate::bag {

/// Reads the messages of an MCAP file of anybody's in the order in which they were recorded, a few
/// chunks at a time: those whose times overlap, at most 1 GiB of them. What is damaged is left out
/// and reported (Contents::losses). One thread at a time.
class McapReader {
 public:
  /// @throws Error when the file cannot be read or is no MCAP file.
  explicit McapReader(const std::string& path) : McapReader(RandomFile(path)) {}
  explicit McapReader(const RandomFile& file) : McapReader(file, walk(file)) {}
  /// The same of a file that was looked at already: `contents` are a reader's of it.
  McapReader(RandomFile file, Contents contents);

  /// Contents of the file; `losses` grow as messages are read.
  [[nodiscard]] const Contents& contents() const { return contents_; }

  /// From now on next() gives only messages of channels that are `wanted`, from time `from` (ns)
  /// on. At first it gives all.
  void choose(const std::function<bool(const Channel&)>& wanted, std::uint64_t from = 0);

  /// The next message by log time, by offset in the file where that is the same; false: there are
  /// no more. Its data are there until the next call. @throws Error when too many chunks overlap.
  [[nodiscard]] bool next(Message& message);

  /// The channel of a message that next() gave.
  [[nodiscard]] const Channel& channel_of(const Message& message) const {
    return contents_.channels.at(message.channel);
  }

  /// Reads one of contents().attachments with its data. @throws Error when it is damaged.
  [[nodiscard]] Attachment attachment(std::size_t index) const;

 private:
  struct Entry {
    std::uint64_t time = 0;
    std::uint32_t begin = 0;  // of the record's content
    std::uint32_t size = 0;
  };
  struct Loaded {
    Bytes records;
    std::vector<Entry> entries;  // by time
    std::size_t next = 0;
    std::uint64_t offset = 0;  // in the file
  };

  void load(const ChunkSpan& span);
  void take(Loaded& chunk, View content, std::size_t begin);
  [[nodiscard]] bool wants(std::uint16_t channel) const;
  [[nodiscard]] Loaded* soonest();

  RandomFile file_;
  Contents contents_;
  std::vector<std::size_t> order_;  // of chunks, by start
  std::size_t upcoming_ = 0;        // in order_
  std::vector<bool> unwanted_;      // by channel's number
  std::uint64_t from_ = 0;          // ns
  std::vector<Loaded> loaded_;
};

}  // namespace palpate::bag
