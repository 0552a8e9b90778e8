#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <string_view>

#include "viewer/connections.hpp"

namespace palpate::viewer {

using RequestParser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

/// Does a request's path ask to open a file: "/open/NAME"?
[[nodiscard]] bool is_upload(std::string_view path) noexcept;

/// Is it a file's name that no system minds: 1 to 128 letters, digits and any of -._, not begun by
/// a dot?
[[nodiscard]] bool is_file_name(std::string_view name) noexcept;

/// Takes over a connection whose `request`, "PUT /open/NAME", has come but for its body: reads that
/// for ViewerControls::open, if the request has the token, answers and closes. One file at a time.
void receive_file(ServerContext& context, boost::beast::tcp_stream stream,
                  boost::beast::flat_buffer buffer, RequestParser&& request);

}  // namespace palpate::viewer
