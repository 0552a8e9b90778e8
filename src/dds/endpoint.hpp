#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dds/domain.hpp"
#include "message/cdr.hpp"
#include "message/schema.hpp"

namespace palpate::dds {

using message::Quality;

/// A topic's name and type: "/camera/depth", "sensor_msgs/Image".
struct TopicType {
  std::string topic;
  const char* type;
  const char* hash;
};

/// Reads the bytes of messages. One thread at a time.
class RawReader {
 public:
  /// @throws Error when the topic's name is not one, or DDS fails.
  RawReader(const Participant& participant, const TopicType& topic, const Quality& quality);
  ~RawReader();
  RawReader(const RawReader&) = delete;
  RawReader& operator=(const RawReader&) = delete;

  /// Hands the oldest message that waits to `use`; false: none waits. What `use` throws goes on.
  bool take(const std::function<void(std::span<const std::uint8_t>)>& use);

  /// Waits at most `timeout` s for a message.
  bool wait(double timeout) const;

  /// Writers that it is matched with.
  [[nodiscard]] std::size_t writers() const;
  /// Messages of one writer that did not arrive, or were replaced by newer ones unread.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] const std::string& topic() const { return topic_; }

 private:
  void count(std::uint64_t writer, std::uint64_t number);

  std::string topic_;
  std::int32_t reader_ = 0;
  std::int32_t waits_ = 0;
  std::uint64_t writer_ = 0;  // of the last message
  std::uint64_t number_ = 0;  // its writer's
  std::uint64_t lost_ = 0;
};

/// Writes the bytes of messages. One thread at a time. May block for 100 ms where a reliable reader
/// is slow.
class RawWriter {
 public:
  /// @throws Error when the topic's name is not one, or DDS fails.
  RawWriter(const Participant& participant, const TopicType& topic, const Quality& quality);
  ~RawWriter();
  RawWriter(const RawWriter&) = delete;
  RawWriter& operator=(const RawWriter&) = delete;

  /// False: it could not be sent in time.
  bool write(std::span<const std::uint8_t> bytes);

  /// Readers that it is matched with.
  [[nodiscard]] std::size_t readers() const;
  [[nodiscard]] const std::string& topic() const { return topic_; }

 private:
  std::string topic_;
  std::int32_t writer_ = 0;
  void* type_ = nullptr;
};

template <message::Message T>
class Reader : public RawReader {
 public:
  Reader(const Participant& participant, const std::string& topic, const Quality& quality)
      : RawReader(participant, {topic, T::kName, T::kHash}, quality) {}

  /// The oldest message that waits. @throws Error when it is damaged; it is then gone.
  bool take(T& message) {
    return RawReader::take([&](std::span<const std::uint8_t> bytes) { decode(bytes, message); });
  }
};

template <message::Message T>
class Writer : public RawWriter {
 public:
  Writer(const Participant& participant, const std::string& topic, const Quality& quality)
      : RawWriter(participant, {topic, T::kName, T::kHash}, quality) {}

  bool write(const T& message) {
    encode(message, bytes_);
    return RawWriter::write(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace palpate::dds
