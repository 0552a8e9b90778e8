#pragma once

#include <cstdint>
#include <unordered_set>

#include "palpate/base/clock.hpp"
#include "palpate/viewer/viewer.hpp"
#include "viewer/lobby.hpp"
#include "viewer/request_check.hpp"

namespace palpate::viewer {

class Connection;

/// What all connections of a server share; the network thread's.
struct Hub {
  ViewerLimits limits;
  Listening listening;
  Lobby& lobby;
  std::unordered_set<Connection*> connections = {};
  std::uint64_t accepted = 0;
  std::uint64_t turned_away = 0;
  std::uint64_t forbidden = 0;
  std::uint64_t closed_silent = 0;

  /// s, on the host's monotonic clock.
  [[nodiscard]] static double now() { return SteadyClock().now(); }
};

/// Something that came in and is not gone yet. It lives as long as an operation of it is under way.
class Connection {
 public:
  explicit Connection(Hub& hub) : hub_(hub) { hub.connections.insert(this); }
  virtual ~Connection() { hub_.connections.erase(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Called now and then: has it been waiting for too long?
  virtual void check(double now) = 0;
  /// The server ends: says so where there is somebody to hear it.
  virtual void end() { abort(); }
  /// Closes it at once, without a word.
  virtual void abort() = 0;

 protected:
  [[nodiscard]] Hub& hub() const { return hub_; }

 private:
  Hub& hub_;
};

}  // namespace palpate::viewer
