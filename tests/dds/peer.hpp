#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "message/schema.hpp"

/// What both ends of the tests with another vendor do: fast_peer.cpp and palpate_peer.cpp.
namespace palpate::peer {

using Bytes = std::vector<std::uint8_t>;

/// One topic and its message.
struct Line {
  std::string name;  ///< "sensor_msgs/msg/Image"
  std::string hash;
  Bytes bytes;

  [[nodiscard]] std::string type() const {  // "sensor_msgs/Image"
    std::string type = name;
    return type.erase(type.find("/msg"), 4);
  }
  [[nodiscard]] std::string dds_type() const { return message::dds_name(type()); }
  [[nodiscard]] std::string topic() const { return "/test/" + type(); }
};

struct Task {
  bool writes = false;
  bool reliable = false;
  double seconds = 0;
  std::vector<Line> lines;
};

inline Task task_of(int count, char** arguments) {
  if (count != 4) std::exit(2);
  Task task{std::string(arguments[1]) == "write",
            std::string(arguments[2]) == "reliable",
            std::stod(arguments[3]),
            {}};
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream words(text);
    Line line;
    std::string hex;
    if (text.empty() || text.front() == ' ' || !(words >> line.name >> line.hash >> hex)) continue;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      line.bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    task.lines.push_back(line);
  }
  return task;
}

inline void print(const Line& line, const Bytes& bytes) {
  std::printf("%s ", line.name.c_str());
  for (const std::uint8_t byte : bytes) std::printf("%02x", byte);
  std::printf("\n");
  std::fflush(stdout);
}

/// 0: all was sent, or all came.
inline int run(const Task& task, const std::function<void(std::size_t, const Bytes&)>& write,
               const std::function<bool(std::size_t, Bytes&)>& take) {
  using Steady = std::chrono::steady_clock;
  const auto end = Steady::now() + std::chrono::duration<double>(task.seconds);
  std::vector<bool> came(task.lines.size());
  std::size_t missing = task.lines.size();
  while (Steady::now() < end && (task.writes || missing > 0)) {
    for (std::size_t i = 0; i < task.lines.size(); ++i) {
      if (task.writes) {
        write(i, task.lines[i].bytes);
      } else if (Bytes bytes; take(i, bytes) && !came[i]) {
        print(task.lines[i], bytes);
        came[i] = true;
        --missing;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(task.writes ? 100 : 5));
  }
  return task.writes || missing == 0 ? 0 : 1;
}

}  // namespace palpate::peer
