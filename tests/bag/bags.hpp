#pragma once

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "message/geometry_types.hpp"
#include "message/sensor_types.hpp"

namespace palpate::bag {

inline constexpr std::uint64_t kSecond = 1'000'000'000;
inline constexpr std::uint64_t kNoon = 1'760'000'000 * kSecond;  ///< where recordings begin

/// A message that was read, with data of its own.
struct Read {
  std::string topic;
  std::uint64_t time = 0;
  Bytes data;
};

inline std::vector<Read> all_of(McapReader& reader) {
  std::vector<Read> read;
  for (Message message; reader.next(message);) {
    read.push_back({reader.channel_of(message).topic, message.stamp.log,
                    Bytes(message.data.begin(), message.data.end())});
  }
  return read;
}

inline std::vector<Read> all_of(const std::string& path) {
  McapReader reader(path);
  return all_of(reader);
}

inline message::PoseStamped pose(int i) {
  message::PoseStamped pose;
  pose.header.stamp.sec = i;
  pose.header.frame_id = "world";
  pose.pose.position.x = 0.001 * i;
  return pose;
}

/// Poses at 100 Hz: `per_chunk` in each of `chunks`.
inline void write_poses(McapWriter& writer, int chunks, int per_chunk) {
  const std::uint16_t topic = writer.add_topic<message::PoseStamped>("/hand/pose");
  for (int i = 0; i < chunks * per_chunk; ++i) {
    const std::uint64_t time = kNoon + static_cast<std::uint64_t>(i) * kSecond / 100;
    writer.write(topic, {time, time}, pose(i));
    if ((i + 1) % per_chunk == 0) writer.advance(time + kSecond);
  }
}

inline std::string contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace palpate::bag
