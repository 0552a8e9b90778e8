#pragma once

#include <zlib.h>

#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/base/error.hpp"

/// MCAP files (mcap.dev/spec), as ROS 2's bags are: what writing and reading share. Times are
/// nanoseconds since 1970. A file is a magic number, records, and the magic number again; a record
/// is a byte that marks what it is, the length of its content, and the content.
namespace palpate::bag {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;
using Words = std::map<std::string, std::string>;

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kRecordHead = 9;    ///< bytes
inline constexpr std::size_t kMessageHead = 22;  ///< bytes of a message's content before its data
inline constexpr std::size_t kFooter = kRecordHead + 20;            ///< bytes
inline constexpr std::uint64_t kFileEnd = kFooter + kMagic.size();  ///< bytes; the last ones
inline constexpr std::uint64_t kLargestChunk = 256 << 20;  ///< bytes before compression (judgement)

enum class Op : std::uint8_t {
  header = 1,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  attachment,
  attachment_index,
  statistics,
  metadata,
  metadata_index,
  summary_offset,
  data_end
};

/// Type of a channel's messages.
struct Schema {
  std::string name;      ///< "sensor_msgs/msg/Image"; empty: a channel without schema
  std::string encoding;  ///< "ros2msg": `text` is what .msg files contain
  std::string text;

  bool operator==(const Schema&) const = default;
};

/// Messages of one topic and one kind.
struct Channel {
  std::string topic;
  Schema schema = {};
  std::string message_encoding = "cdr";
  Words metadata = {};      ///< "offered_qos_profiles", "topic_type_hash"
  std::uint64_t count = 0;  ///< messages; of a channel to be written: not looked at
};

/// When a message was recorded, and when it was sent.
struct Stamp {
  std::uint64_t log = 0;
  std::uint64_t publish = 0;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  Stamp stamp;
  View data;
};

struct Attachment {
  std::string name;
  std::string media_type;
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  Bytes data;
};

struct Metadata {
  std::string name;
  Words words;
};

[[nodiscard]] inline std::uint32_t crc_of(View bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

[[nodiscard]] inline View view_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <std::unsigned_integral Number>
void append(Bytes& out, Number number) {
  const auto bytes = reinterpret_cast<const std::uint8_t*>(&number);
  out.insert(out.end(), bytes, bytes + sizeof(Number));
}

/// Appends a record to bytes; its length is there once this object is gone.
class Record {
 public:
  Record(Bytes& out, Op op) : out_(out) {
    out_.push_back(static_cast<std::uint8_t>(op));
    append(out_, std::uint64_t{0});
    begin_ = out_.size();
  }
  ~Record() { set_length<std::uint64_t>(begin_); }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;

  template <std::unsigned_integral... Number>
  Record& numbers(Number... number) {
    (append(out_, number), ...);
    return *this;
  }
  Record& bytes(View bytes) {
    out_.insert(out_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  Record& text(std::string_view text) {
    return numbers(static_cast<std::uint32_t>(text.size())).bytes(view_of(text));
  }
  /// Appends what `fill` writes, preceded by its length.
  Record& list(const std::function<void()>& fill) {
    numbers(std::uint32_t{0});
    const std::size_t begin = out_.size();
    fill();
    set_length<std::uint32_t>(begin);
    return *this;
  }
  Record& words(const Words& words) {
    return list([&] {
      for (const auto& [key, value] : words) text(key).text(value);
    });
  }
  /// The CRC of the content so far.
  Record& crc() { return numbers(crc_of(View(out_).subspan(begin_))); }

 private:
  template <class Number>
  void set_length(std::size_t begin) {
    const auto length = static_cast<Number>(out_.size() - begin);
    std::memcpy(out_.data() + begin - sizeof(Number), &length, sizeof(Number));
  }

  Bytes& out_;
  std::size_t begin_;
};

/// Takes the values of a record of anybody's. @throws Error, all of it, when there are too few.
class Fields {
 public:
  explicit Fields(View left) : left_(left) {}

  template <std::unsigned_integral Number>
  Number number() {
    Number value = 0;
    std::memcpy(&value, bytes(sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  View bytes(std::uint64_t size) {
    if (size > left_.size()) throw Error("a record is shorter than what it should hold");
    const View taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  std::string text() {
    const View taken = bytes(number<std::uint32_t>());
    return {taken.begin(), taken.end()};
  }
  Words words() {
    Words words;
    for (Fields list(bytes(number<std::uint32_t>())); !list.left_.empty();) {
      std::string key = list.text();
      words[std::move(key)] = list.text();
    }
    return words;
  }
  [[nodiscard]] View left() const { return left_; }

 private:
  View left_;
};

}  // namespace palpate::bag
