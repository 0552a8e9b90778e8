#pragma once

#include <cstddef>
#include <memory>

#include "viewer/beast.hpp"
#include "viewer/client.hpp"
#include "viewer/hub.hpp"

namespace palpate::viewer {

/// A client's WebSocket: hands what it says to the lobby, sends what is in its outbox.
class Socket final : public Connection, public std::enable_shared_from_this<Socket> {
 public:
  Socket(Hub& hub, beast::tcp_stream stream);
  ~Socket() override { forget(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// Answers the request that asked for a socket.
  void run(Request request);
  void check(double now) override;
  void end() override;
  void abort() override;

 private:
  void open();
  void read();
  void take();
  void count_pings();
  void flush();
  void write();
  void close();
  void leave();
  void forget();

  websocket::stream<beast::tcp_stream, false> stream_;  // without compression
  Request request_;
  beast::flat_buffer buffer_;
  Client client_;
  Message sending_;
  std::size_t sent_ = 0;  // bytes of it
  bool writing_ = false;
  double progress_ = 0;  // when the last piece went, or closing began, s
  bool joined_ = false;
  bool closing_ = false;
};

}  // namespace palpate::viewer
