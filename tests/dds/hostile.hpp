#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"

/// What tests of nodes that send what no node should have in common.
namespace palpate::hostile {

using Bytes = std::vector<std::uint8_t>;

inline constexpr double kPatience = 20;            ///< s that a loaded machine may take
inline constexpr double kMostMemory = 64'000'000;  ///< bytes that may be held for what floods in

/// Tests that run side by side have a domain each.
inline dds::DomainOptions own_domain() {
  setenv("ROS_DOMAIN_ID", std::to_string(100 + getpid() % 100).c_str(), 1);
  return dds::environment_options();
}

using message::system_now;

/// What of this process is resident, bytes.
inline double memory() {
  double all = 0;
  double resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Asks `done` until it is true; false: it was not in time.
inline bool before_long(const std::function<bool()>& done) {
  SteadyClock clock;
  for (const double end = clock.now() + kPatience; clock.now() < end;) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

template <class T>
Bytes bytes_of(const T& message) {
  Bytes bytes;
  encode(message, bytes);
  return bytes;
}

}  // namespace palpate::hostile
