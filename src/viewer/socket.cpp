#include "viewer/socket.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

namespace palpate::viewer {
namespace {

// A message goes in pieces, so that one that goes slowly is told from one that does not go.
constexpr std::size_t kPiece = 64 * 1024;
// The system keeps no more than this for a client that does not take it: what it kept is old.
constexpr int kSystemBuffer = 256 * 1024;
constexpr double kClosing = 2;  // s for the other side to close, too
constexpr std::size_t kLongestReason = 123;

}  // namespace

Socket::Socket(Hub& hub, beast::tcp_stream stream)
    : Connection(hub),
      stream_(std::move(stream)),
      client_(hub.limits, Hub::now()),
      progress_(Hub::now()) {}

void Socket::run(Request request) {
  request_ = std::move(request);
  auto& lowest = beast::get_lowest_layer(stream_);
  lowest.expires_never();
  beast::error_code ignored;
  lowest.socket().set_option(Tcp::no_delay(true), ignored);
  lowest.socket().set_option(net::socket_base::send_buffer_size(kSystemBuffer), ignored);
  stream_.set_option(
      websocket::stream_base::timeout{std::chrono::duration_cast<websocket::stream_base::duration>(
                                          std::chrono::duration<double>(hub().limits.header_time)),
                                      websocket::stream_base::none(), false});
  stream_.read_message_max(hub().limits.message);
  stream_.auto_fragment(false);
  stream_.async_accept(request_, [self = shared_from_this()](const beast::error_code& error) {
    if (!error) self->open();
  });
}

void Socket::open() {
  request_ = {};
  joined_ = true;
  client_.wake = [this] { flush(); };
  hub().lobby.join(client_);
  count_pings();
  read();
}

void Socket::read() {
  stream_.async_read(buffer_,
                     [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                       if (error) {
                         self->leave();
                       } else {
                         self->take();
                       }
                     });
}

void Socket::take() {
  const net::const_buffer data = buffer_.data();
  if (stream_.got_text()) {
    const std::string_view text(static_cast<const char*>(data.data()), data.size());
    hub().lobby.take(client_, text, Hub::now());
  } else {
    hub().lobby.take_binary(client_, Hub::now());
  }
  buffer_.consume(buffer_.size());
  read();
}

// Pings are answered below us; too many of them are too many messages, too.
void Socket::count_pings() {
  stream_.control_callback([this](websocket::frame_type, beast::string_view) {
    if (client_.closing || !client_.messages.exceeded(Hub::now())) return;
    client_.closing = Closing{close_code::kPolicy, "too many pings"};
    net::post(stream_.get_executor(), [self = shared_from_this()] { self->flush(); });
  });
}

void Socket::flush() {
  if (writing_ || closing_ || !joined_) return;
  if (std::optional<Message> next = client_.outbox.take()) {
    sending_ = std::move(*next);
    sent_ = 0;
    writing_ = true;
    progress_ = Hub::now();
    stream_.text(sending_.text);
    write();
  } else if (client_.closing) {
    close();
  }
}

void Socket::write() {
  const std::size_t size = std::min(kPiece, sending_.bytes->size() - sent_);
  const bool last = sent_ + size == sending_.bytes->size();
  stream_.async_write_some(
      last, net::buffer(sending_.bytes->data() + sent_, size),
      [self = shared_from_this(), last](const beast::error_code& error, std::size_t written) {
        self->progress_ = Hub::now();
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

void Socket::close() {
  closing_ = true;
  progress_ = Hub::now();
  const std::string& words = client_.closing->reason;
  websocket::close_reason reason(client_.closing->code);
  reason.reason.assign(words.data(), std::min(words.size(), kLongestReason));
  stream_.async_close(reason,
                      [self = shared_from_this()](const beast::error_code&) { self->leave(); });
}

void Socket::check(double now) {
  const double patience = closing_ ? kClosing : hub().limits.silence;
  if ((!writing_ && !closing_) || now - progress_ <= patience) return;
  if (!closing_) ++hub().closed_silent;
  abort();
}

void Socket::abort() {
  beast::get_lowest_layer(stream_).close();
}

void Socket::end() {
  if (!joined_) return abort();
  client_.outbox = {};
  if (!client_.closing) client_.closing = Closing{close_code::kGoingAway, "the program ends"};
  flush();
}

void Socket::leave() {
  forget();
  abort();
}

void Socket::forget() {
  if (!std::exchange(joined_, false)) return;
  client_.wake = nullptr;
  hub().lobby.leave(client_);
}

}  // namespace palpate::viewer
