#include "viewer/http_connection.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "viewer/page.hpp"
#include "viewer/socket.hpp"

namespace palpate::viewer {
namespace {

constexpr std::string_view kPlain = "text/plain; charset=utf-8";
constexpr const char* kPolicy =
    "default-src 'self'; connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

std::string_view path_of(const Request& request) {
  const std::string_view target = view(request.target());
  return target.substr(0, target.find('?'));
}

}  // namespace

HttpConnection::HttpConnection(Hub& hub, Tcp::socket socket)
    : Connection(hub), stream_(std::move(socket)), buffer_(2 * hub.limits.header) {}

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(hub().limits.header);
  give_time();
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                     if (!error) self->take(self->parser_->get());
                   });
}

void HttpConnection::give_time() {
  stream_.expires_after(std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(hub().limits.header_time)));
}

void HttpConnection::take(const Request& request) {
  if (!may(request)) {
    ++hub().forbidden;
    send(request, {http::status::forbidden, kPlain,
                   "This page is asked for under another name than the program printed."});
  } else if (path_of(request) == "/live" && websocket::is_upgrade(request)) {
    std::make_shared<Socket>(hub(), std::move(stream_))->run(parser_->release());
  } else {
    send(request, find(request));
  }
}

bool HttpConnection::may(const Request& request) {
  const std::string_view host = view(request[http::field::host]);
  if (request.count(http::field::host) != 1 || !host_is_ours(host, hub().listening)) return false;
  const std::size_t origins = request.count(http::field::origin);
  return origins == 0 || (origins == 1 && origin_is_ours(view(request[http::field::origin]), host));
}

HttpConnection::Answer HttpConnection::find(const Request& request) {
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    return {http::status::method_not_allowed, kPlain, "Only GET is answered here."};
  }
  if (path_of(request) == "/live") {
    return {http::status::upgrade_required, kPlain, "This is the address of a WebSocket."};
  }
  const auto files = page_files();
  const auto found = std::ranges::find(files, path_of(request), &PageFile::path);
  if (found == files.end()) return {http::status::not_found, kPlain, "There is no such file."};
  return {http::status::ok, found->type, found->bytes};
}

void HttpConnection::send(const Request& request, const Answer& answer) {
  auto& response = response_.emplace(answer.status, request.version());
  response.set(http::field::content_type,
               beast::string_view(answer.type.data(), answer.type.size()));
  response.set(http::field::cache_control, "no-store");
  response.set("Content-Security-Policy", kPolicy);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.content_length(answer.bytes.size());
  response.keep_alive(request.keep_alive() && answer.status == http::status::ok);
  if (request.method() != http::verb::head) {
    response.body() = beast::span<const char>(answer.bytes.data(), answer.bytes.size());
  }
  give_time();
  http::async_write(stream_, response,
                    [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                      if (error) return;
                      self->response_->keep_alive() ? self->read() : self->finish();
                    });
}

void HttpConnection::finish() {
  beast::error_code ignored;
  stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
}

}  // namespace palpate::viewer
