#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <string>
#include <string_view>

#include "viewer/connections.hpp"

namespace palpate::viewer {

using RequestParser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

/// Does a request's path open a file: "/open/NAME"?
[[nodiscard]] bool is_upload(std::string_view path) noexcept;

/// A file's name as a request's path writes it, with %XX for what is no letter there; empty: it is
/// none, of 1 to 250 bytes without '/' and control characters, not begun by a dot.
[[nodiscard]] std::string file_name(std::string_view written);

/// Takes over a connection whose `request`, "PUT /open/NAME", has come but for its body: reads that
/// for ViewerControls::open, if the request has the token, answers and closes. One file at a time.
void receive_file(ServerContext& context, boost::beast::tcp_stream stream,
                  boost::beast::flat_buffer buffer, RequestParser&& request);

}  // namespace palpate::viewer
