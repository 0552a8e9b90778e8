#pragma once

#include <string>
#include <utility>

#include "bag/mcap_format.hpp"
#include "bag/mcap_summary.hpp"
#include "message/schema.hpp"

namespace palpate::bag {

/// Quality that a topic offers when the bag is played: rosbag2's YAML, in numbers that all its
/// versions read.
[[nodiscard]] std::string offered_qos(const message::Quality& quality);

/// Writes a bag (profile ros2). After each chunk the file is closed with all that a reader wants to
/// find at its end, and what follows replaces that: if the program or the machine stops, no more
/// than what was not in a chunk is lost. Where that end has grown beyond 256 KiB (some two thousand
/// chunks), it is written at every sync only; a file without it is read all the same.
///
/// One thread at a time. write() may take as long as the disk does: not for a servo's thread. Reads
/// no clock: time is what messages and advance() state. Every function that writes throws Error
/// that names the file and the reason (a full disk); the file then ends with the last chunk that
/// was written whole, and takes no more.
class McapWriter {
 public:
  struct Options {
    std::size_t chunk_size = 1 << 20;          ///< bytes; a chunk that reaches it is written
    std::uint64_t chunk_time = 1'000'000'000;  ///< ns; so is one that began that long ago
    std::uint64_t sync_time = 5'000'000'000;   ///< ns between two waits for the disk
    bool compressed = true;                    ///< by zstd, level 1
    std::string profile = "ros2";
  };

  /// Makes the file; one that was there is replaced.
  McapWriter(std::string path, const Options& options);
  explicit McapWriter(std::string path) : McapWriter(std::move(path), Options{}) {}
  /// close(), but what goes wrong is not reported.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// The channel's number, for write(). It is in the file from its first message on.
  [[nodiscard]] std::uint16_t add_channel(const Channel& channel);

  /// The same for messages of one of our types.
  template <message::Message T>
  [[nodiscard]] std::uint16_t add_topic(const std::string& topic,
                                        const message::Quality& quality = {.reliable = true}) {
    Channel channel{topic, {message::ros_name(T::kName), "ros2msg", message::schema_of<T>()}};
    channel.metadata["offered_qos_profiles"] = offered_qos(quality);
    if (T::kHash[0] != '\0')
      channel.metadata["topic_type_hash"] = std::string("RIHS01_") + T::kHash;
    return add_channel(channel);
  }

  /// A message of a channel, already encoded. Its sequence number counts those of the channel.
  void write(std::uint16_t channel, const Stamp& stamp, View data);

  template <message::Message T>
  void write(std::uint16_t channel, const Stamp& stamp, const T& message) {
    message::encode(message, encoded_);
    write(channel, stamp, View(encoded_));
  }

  /// Files and notes that belong to the recording; written at once.
  void attach(const Attachment& attachment);
  void add(const Metadata& metadata);

  /// Sets the time (ns) where no message does: writes and syncs what is due.
  void advance(std::uint64_t now);

  /// Writes what is left, waits for the disk, closes the file.
  void close();

 private:
  void write_chunk();
  void append_chunk(Bytes& out, std::uint64_t start, std::uint64_t end);
  void commit(Bytes& data, McapSummary::Totals after);
  [[nodiscard]] bool put(std::uint64_t at, const Bytes& data) const;
  void sync();
  void check_open() const;
  [[noreturn]] void give_up(int reason);

  std::string path_;
  Options options_;
  int file_ = -1;
  bool failed_ = false;
  bool ended_ = false;        // the file is closed as it is
  std::uint64_t end_ = 0;     // of its data
  std::uint64_t synced_ = 0;  // when
  bool began_ = false;        // there is a time
  McapSummary summary_;

  Bytes chunk_;  // that grows
  std::uint64_t chunk_began_ = 0;
  Bytes encoded_;
};

}  // namespace palpate::bag
