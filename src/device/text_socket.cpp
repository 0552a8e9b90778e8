// Implements a WebSocket client whose every wait is limited.
#include "device/text_socket.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <string_view>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using Tcp = net::ip::tcp;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kLongestText = 64 * 1024;  // bytes of a message (judgement)
// s for the other side to read the close frame (judgement)
constexpr double kSocketFarewell = 0.05;

struct Url {
  std::string host;
  std::string port;
  std::string path;
};

Url parse_url(const std::string& url) {
  constexpr std::string_view kScheme = "ws://";
  const std::string_view rest =
      url.starts_with(kScheme) ? std::string_view(url).substr(kScheme.size()) : "";
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string_view authority = rest.substr(0, slash);
  const std::size_t colon = authority.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == authority.size()) {
    throw Error(fmt::format(
        "'{}' is not an address; write ws://HOST:PORT, as in ws://localhost:10001", url));
  }
  const std::string_view path = rest.substr(slash);
  return {std::string(authority.substr(0, colon)), std::string(authority.substr(colon + 1)),
          path.empty() ? "/" : std::string(path)};
}

}  // namespace

struct TextSocket::Inside {
  // Runs what is to be done until `done` or `patience` s are over; false: they are.
  template <class Done>
  bool run(double patience, Done done) {
    const auto end =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(patience));
    while (!done()) {
      io.restart();
      if (io.run_one_until(end) == 0 && !done()) return false;
    }
    return true;
  }

  void connect(const Url& url, double patience) {
    bool done = false;
    Tcp::resolver resolver(io);
    beast::get_lowest_layer(socket).expires_after(
        std::chrono::duration_cast<std::chrono::milliseconds>(Seconds(patience)));
    const auto finish = [&](const beast::error_code& failed) {
      error = failed;
      done = true;
    };
    resolver.async_resolve(
        url.host, url.port,
        [&](const beast::error_code& failed, const Tcp::resolver::results_type& found) {
          if (failed) return finish(failed);
          beast::get_lowest_layer(socket).async_connect(
              found, [&](const beast::error_code& refused, const Tcp::endpoint&) {
                if (refused) return finish(refused);
                beast::error_code ignored;
                beast::get_lowest_layer(socket).socket().set_option(Tcp::no_delay(true), ignored);
                socket.async_handshake(url.host + ":" + url.port, url.path, finish);
              });
        });
    run(2 * patience, [&done] { return done; });
    if (!done) {
      resolver.cancel();
      beast::get_lowest_layer(socket).close();
      // Operations still in progress refer to local variables: wait for their end.
      io.restart();
      while (!done && io.run_one() > 0) {
      }
      error = net::error::timed_out;
    }
    beast::get_lowest_layer(socket).expires_never();
  }

  void read() {
    socket.async_read(buffer, [this](const beast::error_code& failed, std::size_t) {
      if (failed) {
        error = failed;
        return;
      }
      newest = beast::buffers_to_string(buffer.data());
      buffer.consume(buffer.size());
      ++received;
      read();
    });
  }

  void require() const {
    if (error) throw Error(fmt::format("the connection was closed ({})", error.message()));
  }

  net::io_context io{1};
  websocket::stream<beast::tcp_stream, false> socket{io};  // without compression
  beast::flat_buffer buffer;
  std::string newest;
  std::uint64_t received = 0;
  std::string sending;
  bool sent = true;
  beast::error_code error;
};

TextSocket::TextSocket(const std::string& url, double patience)
    : inside_(std::make_unique<Inside>()) {
  Inside& in = *inside_;
  in.connect(parse_url(url), patience);
  if (in.error) throw Error(fmt::format("no answer from {} ({})", url, in.error.message()));
  in.socket.text(true);
  in.socket.read_message_max(kLongestText);
  in.read();
}

TextSocket::~TextSocket() {
  Inside& in = *inside_;
  bool closed = false;
  if (in.sent && !in.error) {
    in.socket.async_close(websocket::close_code::normal,
                          [&closed](const beast::error_code&) { closed = true; });
    in.run(kSocketFarewell, [&closed] { return closed; });
  }
  beast::get_lowest_layer(in.socket).close();
  in.io.restart();
  in.io.poll();  // what is in progress ends before what it refers to
}

void TextSocket::send(std::string text, double patience) {
  Inside& in = *inside_;
  const auto taken = [&in] { return in.sent || in.error; };
  if (!in.run(patience, taken)) throw Error("the server stopped reading");
  in.require();
  in.sending = std::move(text);
  in.sent = false;
  in.socket.async_write(net::buffer(in.sending),
                        [&in](const beast::error_code& failed, std::size_t) {
                          if (failed) in.error = failed;
                          in.sent = true;
                        });
  if (!in.run(patience, taken)) throw Error("the server stopped reading");
  in.require();
}

void TextSocket::poll() {
  inside_->io.restart();
  inside_->io.poll();
  inside_->require();
}

bool TextSocket::wait(std::uint64_t count, double patience) {
  Inside& in = *inside_;
  const bool came = in.run(patience, [&] { return in.received > count || in.error; });
  if (in.received <= count) in.require();
  return came;
}

std::uint64_t TextSocket::received() const {
  return inside_->received;
}

const std::string& TextSocket::newest() const {
  return inside_->newest;
}

}  // namespace palpate::device
