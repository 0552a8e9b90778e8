// Declares the connections of the viewer's server.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <unordered_set>

#include "palpate/base/clock.hpp"
#include "viewer/access.hpp"
#include "viewer/client_sessions.hpp"

namespace palpate::viewer {

namespace net = boost::asio;
using Tcp = net::ip::tcp;
using ErrorCode = boost::system::error_code;

inline std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(seconds));
}

class Connection;

/// Shared by all connections of a server; network thread only.
struct ServerContext {
  ViewerOptions::Limits limits;
  Listening listening;
  ClientSessions& sessions;
  bool receives_file = false;
  Closing end = {close_code::kGoingAway, "the program is exiting"};  // of all clients
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
  explicit Connection(ServerContext& context) : context_(context) {
    context.connections.insert(this);
  }
  virtual ~Connection() { context_.connections.erase(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Called now and then: has it been waiting for too long?
  virtual void check(double now) = 0;
  /// The server ends: notifies its client where there is one.
  virtual void end() { abort(); }
  /// Closes it at once, without a word.
  virtual void abort() = 0;

 protected:
  [[nodiscard]] ServerContext& context() const { return context_; }

 private:
  ServerContext& context_;
};

/// Serves one connection until it ends: files of the page, or a client's WebSocket.
void serve(ServerContext& context, Tcp::socket socket);

}  // namespace palpate::viewer
