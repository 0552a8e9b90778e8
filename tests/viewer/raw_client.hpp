#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate::test {

/// A WebSocket message or close frame as it came.
struct Frame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping, 10 pong
  std::string payload;

  [[nodiscard]] bool binary(int kind) const {
    return opcode == 2 && !payload.empty() && payload[0] == kind;
  }
  /// The status of a close frame.
  [[nodiscard]] int code() const {
    return payload.size() < 2 ? 0
                              : static_cast<unsigned char>(payload[0]) * 256 +
                                    static_cast<unsigned char>(payload[1]);
  }
};

/// A frame as a client sends it.
[[nodiscard]] std::string client_frame(int opcode, std::string_view payload);

/// A client of its own making, so that it can misbehave: a TCP connection to a port of this
/// machine. Waits up to 60 s for bytes; a test that comes so far has failed.
class RawClient {
 public:
  enum class Loopback { v4, v6 };

  /// @throws std::runtime_error likewise in all that follows.
  explicit RawClient(std::uint16_t port, Loopback loopback = Loopback::v4);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void send(std::string_view bytes);
  /// Sends until the other side has closed or takes nothing for some milliseconds.
  void flood(std::string_view bytes);
  /// Until the end of a header; its body, if any, is read by read_body().
  std::string read_header();
  std::string read_body(const std::string& header);
  /// True: the other side has closed, and nothing more came.
  bool ends();

  /// Asks for the socket; the answer's header.
  std::string upgrade(const std::string& host, const std::string& origin = "");
  void send_text(std::string_view text) { send_frame(1, text); }
  void send_frame(int opcode, std::string_view payload) { send(client_frame(opcode, payload)); }
  /// The next message or close frame; pieces are put together.
  Frame receive();
  /// The next message for which `wanted` holds; a close frame ends in an exception.
  template <class Wanted>
  Frame receive_until(const Wanted& wanted) {
    while (true) {
      Frame frame = receive();
      if (wanted(frame)) return frame;
      if (frame.opcode == 8) throw std::runtime_error("closed: " + frame.payload.substr(2));
    }
  }
  /// The next text message of a type.
  nlohmann::json receive_json(const std::string& type);
  /// The code of the close frame that comes next of all close frames; 0: closed without one.
  int receive_close();

 private:
  std::string take(std::size_t size);
  bool fill();
  [[nodiscard]] bool connect(std::uint16_t port, Loopback loopback) const;

  int socket_ = -1;
  std::string read_;  // and not taken yet
};

/// "127.0.0.1:PORT".
[[nodiscard]] std::string local(std::uint16_t port);

}  // namespace palpate::test
