#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "viewer/beast.hpp"
#include "viewer/hub.hpp"

namespace palpate::viewer {

/// Answers requests for the page, and becomes a Socket when that is asked for.
class HttpConnection final : public Connection,
                             public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Hub& hub, Tcp::socket socket);

  void run() { read(); }
  void check(double) override {}  // the stream's own timer does
  void abort() override { stream_.close(); }

 private:
  struct Answer {
    http::status status;
    std::string_view type;
    std::string_view bytes;
  };

  void read();
  void give_time();
  void take(const Request& request);
  [[nodiscard]] bool may(const Request& request);
  [[nodiscard]] static Answer find(const Request& request);
  void send(const Request& request, const Answer& answer);
  void finish();

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<http::response<http::span_body<const char>>> response_;
};

}  // namespace palpate::viewer
