// Serves HTTP files and WebSockets to browsers.
#include "viewer/connections.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "viewer/server.hpp"
#include "viewer/upload.hpp"

namespace palpate::viewer {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using Request = http::request<http::empty_body>;
constexpr std::string_view kPlain = "text/plain; charset=utf-8";
constexpr const char* kPolicy =
    "default-src 'self'; connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";
// A message goes in pieces, so that one that goes slowly differs from one that is stuck (judgement)
constexpr std::size_t kPiece = 64 * 1024;
// The system keeps no more than this for a client that does not take it: what it kept is old.
constexpr int kSystemBuffer = 256 * 1024;
constexpr double kClosing = 2;               // s for the other side to close, too (judgement)
constexpr std::size_t kLongestReason = 123;  // bytes; a close frame's limit (RFC 6455, 5.5)

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}
std::string_view path_of(const Request& request) {
  const std::string_view target = view(request.target());
  return target.substr(0, target.find('?'));
}

// A client's WebSocket: hands its messages to the sessions, sends what is in its outbox.
class Socket final : public Connection, public std::enable_shared_from_this<Socket> {
 public:
  Socket(ServerContext& context, beast::tcp_stream stream)
      : Connection(context),
        stream_(std::move(stream)),
        session_(context.limits, ServerContext::now()),
        progress_(ServerContext::now()) {}
  ~Socket() override { forget(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  // Answers the request for a socket.
  void run(Request request) {
    request_ = std::move(request);
    auto& lowest = beast::get_lowest_layer(stream_);
    lowest.expires_never();
    ErrorCode ignored;
    lowest.socket().set_option(Tcp::no_delay(true), ignored);
    lowest.socket().set_option(net::socket_base::send_buffer_size(kSystemBuffer), ignored);
    stream_.set_option(websocket::stream_base::timeout{nanoseconds(context().limits.header_time),
                                                       websocket::stream_base::none(), false});
    stream_.read_message_max(context().limits.message);
    stream_.auto_fragment(false);
    stream_.async_accept(request_, [self = shared_from_this()](const ErrorCode& error) {
      if (!error) self->open();
    });
  }

  void check(double now) override {
    const double patience = closing_ ? kClosing : context().limits.silence;
    if ((!writing_ && !closing_) || now - progress_ <= patience) return;
    if (!closing_) ++context().closed_silent;
    abort();
  }
  void end() override {
    if (!joined_) return abort();
    session_.outbox = {};
    if (!session_.closing) session_.closing = context().end;
    flush();
  }
  void abort() override { beast::get_lowest_layer(stream_).close(); }

 private:
  void open() {
    request_ = {};
    joined_ = true;
    session_.wake = [this] { flush(); };
    context().sessions.join(session_);
    count_pings();
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](const ErrorCode& error, std::size_t) {
      error ? self->leave() : self->receive();
    });
  }

  void receive() {
    const net::const_buffer data = buffer_.data();
    if (stream_.got_text()) {
      const std::string_view text(static_cast<const char*>(data.data()), data.size());
      context().sessions.receive(session_, text, ServerContext::now());
    } else {
      context().sessions.refuse(session_, "binary message; send JSON", ServerContext::now());
    }
    buffer_.consume(buffer_.size());
    read();
  }

  // Pings are answered below us; too many of them are too many messages, too.
  void count_pings() {
    stream_.control_callback([this](websocket::frame_type, beast::string_view) {
      if (session_.closing || !session_.messages.exceeded(ServerContext::now())) return;
      session_.closing = Closing{close_code::kPolicy, "too many pings"};
      net::post(stream_.get_executor(), [self = shared_from_this()] { self->flush(); });
    });
  }

  void flush() {
    if (writing_ || closing_ || !joined_) return;
    if (std::optional<Message> next = session_.outbox.take()) {
      sending_ = std::move(*next);
      sent_ = 0;
      writing_ = true;
      progress_ = ServerContext::now();
      stream_.text(sending_.text);
      write();
    } else if (session_.closing) {
      close();
    }
  }

  void write() {
    const std::size_t size = std::min(kPiece, sending_.bytes->size() - sent_);
    const bool last = sent_ + size == sending_.bytes->size();
    stream_.async_write_some(
        last, net::buffer(sending_.bytes->data() + sent_, size),
        [self = shared_from_this(), last](const ErrorCode& error, std::size_t written) {
          self->progress_ = ServerContext::now();
          self->sent_ += written;
          if (!error && !last) {
            self->write();
            return;
          }
          self->writing_ = false;
          self->sending_ = {};
          error ? self->leave() : self->flush();
        });
  }

  // A read with a control callback and a close may wait for each other; so drop it, post the close.
  void close() {
    closing_ = true;
    stream_.control_callback();
    progress_ = ServerContext::now();
    const std::string& words = session_.closing->reason;
    websocket::close_reason reason(session_.closing->code);
    std::size_t size = std::min(words.size(), kLongestReason);
    while (size < words.size() && (words[size] & 0xc0) == 0x80) --size;  // whole letters of UTF-8
    reason.reason.assign(words.data(), size);
    net::post(stream_.get_executor(), [self = shared_from_this(), reason] {
      self->stream_.async_close(reason, [self](const ErrorCode&) { self->leave(); });
    });
  }

  void leave() {
    forget();
    abort();
  }

  void forget() {
    if (!std::exchange(joined_, false)) return;
    session_.wake = nullptr;
    context().sessions.leave(session_);
  }

  websocket::stream<beast::tcp_stream, false> stream_;  // without compression
  Request request_;
  beast::flat_buffer buffer_;
  Session session_;
  Message sending_;
  std::size_t sent_ = 0;  // bytes of it
  bool writing_ = false;
  double progress_ = 0;  // when the last piece went, or closing began, s
  bool joined_ = false;
  bool closing_ = false;
};

// Answers requests for the page, and becomes a Socket when that is requested.
class HttpConnection final : public Connection,
                             public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(ServerContext& context, Tcp::socket socket)
      : Connection(context), stream_(std::move(socket)), buffer_(2 * context.limits.header) {}

  void run() {
    parser_.emplace();
    parser_->header_limit(context().limits.header);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read here
    stream_.expires_after(nanoseconds(context().limits.header_time));
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](const ErrorCode& error, std::size_t) {
                              if (!error) self->answer(self->parser_->get());
                            });
  }
  void check(double) override {}  // the stream's own timer does
  void abort() override { stream_.close(); }

 private:
  struct Answer {
    http::status status;
    std::string_view type;
    std::string_view bytes;
  };

  void answer(const Request& request) {
    if (!is_allowed(request)) {
      ++context().forbidden;
      send(request, {http::status::forbidden, kPlain,
                     "Wrong host name; use the address that the program printed."});
    } else if (path_of(request) == "/live" && websocket::is_upgrade(request)) {
      std::make_shared<Socket>(context(), std::move(stream_))->run(parser_->release());
    } else if (is_upload(path_of(request)) && request.method() == http::verb::put) {
      receive_file(context(), std::move(stream_), std::move(buffer_), std::move(*parser_));
    } else {
      send(request, find(request));
    }
  }

  [[nodiscard]] bool is_allowed(const Request& request) const {
    const std::string_view host = view(request[http::field::host]);
    if (request.count(http::field::host) != 1 || !host_is_ours(host, context().listening)) {
      return false;
    }
    const std::size_t origins = request.count(http::field::origin);
    return origins == 0 ||
           (origins == 1 && origin_is_ours(view(request[http::field::origin]), host));
  }

  [[nodiscard]] static Answer find(const Request& request) {
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return {http::status::method_not_allowed, kPlain, "Only GET is supported."};
    }
    if (path_of(request) == "/live") {
      return {http::status::upgrade_required, kPlain, "This address is a WebSocket."};
    }
    const auto files = page_files();
    const auto found = std::ranges::find(files, path_of(request), &PageFile::path);
    if (found == files.end()) return {http::status::not_found, kPlain, "No such file."};
    return {http::status::ok, found->type, found->bytes};
  }

  void send(const Request& request, const Answer& answer) {
    auto& response = response_.emplace(answer.status, request.version());
    response.set(http::field::content_type,
                 beast::string_view(answer.type.data(), answer.type.size()));
    response.set(http::field::cache_control, "no-store");
    response.set("Content-Security-Policy", kPolicy);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.content_length(answer.bytes.size());
    const bool whole = parser_->is_done();  // what follows is no body that nobody reads
    response.keep_alive(request.keep_alive() && whole && answer.status == http::status::ok);
    if (request.method() != http::verb::head) {
      response.body() = beast::span<const char>(answer.bytes.data(), answer.bytes.size());
    }
    stream_.expires_after(nanoseconds(context().limits.header_time));
    http::async_write(stream_, response,
                      [self = shared_from_this()](const ErrorCode& error, std::size_t) {
                        if (error) return;
                        self->response_->keep_alive() ? self->run() : self->finish();
                      });
  }

  void finish() {
    ErrorCode ignored;
    stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<RequestParser> parser_;
  std::optional<http::response<http::span_body<const char>>> response_;
};

}  // namespace

void serve(ServerContext& context, Tcp::socket socket) {
  std::make_shared<HttpConnection>(context, std::move(socket))->run();
}

}  // namespace palpate::viewer
