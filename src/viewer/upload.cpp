// Receives a file that a page uploads.
#include "viewer/upload.hpp"

#include <algorithm>
#include <array>
#include <boost/beast/http.hpp>
#include <charconv>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "viewer/access.hpp"
#include "viewer/client_sessions.hpp"

namespace palpate::viewer {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::string_view kPath = "/open/";
constexpr std::string_view kBearer = "Bearer ";
constexpr std::size_t kLongestName = 250;  // bytes; file systems take 255 (docs/viewer_protocol.md)
constexpr double kPatience = 5;  // s for an answer to go and the other side to close (judgement)

bool is_in_no_name(char c) {
  return (c >= 0 && c < 0x20) || c == 0x7f || c == '/';
}

class Upload final : public Connection, public std::enable_shared_from_this<Upload> {
 public:
  Upload(ServerContext& context, beast::tcp_stream stream, beast::flat_buffer buffer,
         RequestParser&& request)
      : Connection(context),
        stream_(std::move(stream)),
        buffer_(std::move(buffer)),
        request_(std::move(request)) {}
  ~Upload() override { make_room(); }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  void run() {
    const beast::string_view target = request_.get().target();
    const std::string_view path(target.data(), target.size());
    name_ = file_name(path.substr(std::min(path.size(), kPath.size())));
    const beast::string_view header = request_.get()[http::field::authorization];
    const std::string_view words(header.data(), header.size());
    const bool authorized =
        words.starts_with(kBearer) && same_token(words.substr(kBearer.size()), options().token);
    if (!authorized) {
      ++context().forbidden;
      return answer(http::status::unauthorized, "Wrong token.");
    }
    if (!options().controls.open)
      return answer(http::status::not_found, "This run opens no files.");
    if (name_.empty()) {
      return answer(http::status::bad_request,
                    "A file's name has 1 to 250 bytes, no / and no control character, and does not "
                    "begin with a dot.");
    }
    if (context().receives_file) {
      return answer(http::status::conflict, "Another file is being sent; try again after it.");
    }
    const std::size_t most = context().limits.file;
    if (request_.content_length().value_or(0) > most) return answer_too_large();
    request_.body_limit(most);
    context().receives_file = reads_ = true;
    go_on({});
  }

  void check(double /*now*/) override {}  // the stream's own timer does
  void abort() override { stream_.close(); }

 private:
  [[nodiscard]] const ClientSessionsOptions& options() const {
    return context().sessions.options();
  }

  // In pieces: one that comes slowly is distinguished from one that does not come.
  void read() {
    stream_.expires_after(nanoseconds(context().limits.header_time));
    http::async_read_some(
        stream_, buffer_, request_,
        [self = shared_from_this()](const ErrorCode& error, std::size_t) { self->go_on(error); });
  }

  void go_on(const ErrorCode& error) {
    if (error == http::error::body_limit) return answer_too_large();
    if (error) return;
    request_.is_done() ? hand_over() : read();
  }

  void hand_over() {
    try {
      options().controls.open(name_, std::move(request_.get().body()));
    } catch (const std::exception& error) {
      return answer(http::status::conflict, error.what());
    }
    answer(http::status::accepted, "");
  }

  void answer_too_large() {
    answer(http::status::payload_too_large,
           "The file is too large for the page; give it to the program on its command line.");
  }

  void make_room() {
    if (std::exchange(reads_, false)) context().receives_file = false;
  }

  void answer(http::status status, std::string words) {
    make_room();
    auto& response = response_.emplace(status, request_.get().version(), std::move(words));
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.keep_alive(false);
    response.prepare_payload();
    stream_.expires_after(nanoseconds(kPatience));
    http::async_write(stream_, response,
                      [self = shared_from_this()](const ErrorCode& error, std::size_t) {
                        if (error) return;
                        ErrorCode ignored;
                        self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                        self->drain();
                      });
  }

  // A connection that is closed before all was read takes its answer with it.
  void drain() {
    stream_.async_read_some(net::buffer(rest_),
                            [self = shared_from_this()](const ErrorCode& error, std::size_t) {
                              if (!error) self->drain();
                            });
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> request_;
  std::optional<http::response<http::string_body>> response_;
  std::string name_;
  bool reads_ = false;
  std::array<char, 4096> rest_;
};

}  // namespace

bool is_upload(std::string_view path) noexcept {
  return path.starts_with(kPath);
}

std::string file_name(std::string_view written) {
  std::string name;
  while (!written.empty()) {
    std::size_t size = 1;
    char letter = written.front();
    if (letter == '%') {
      unsigned code = 0;
      const char* const end = written.data() + std::min<std::size_t>(3, written.size());
      const auto read = std::from_chars(written.data() + 1, end, code, 16);
      if (read.ptr != written.data() + 3) return {};
      letter = static_cast<char>(code);
      size = 3;
    }
    if (is_in_no_name(letter)) return {};
    name += letter;
    written.remove_prefix(size);
  }
  return name.size() <= kLongestName && !name.starts_with('.') ? name : "";
}

void receive_file(ServerContext& context, beast::tcp_stream stream, beast::flat_buffer buffer,
                  RequestParser&& request) {
  std::make_shared<Upload>(context, std::move(stream), std::move(buffer), std::move(request))
      ->run();
}

}  // namespace palpate::viewer
