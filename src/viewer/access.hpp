#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::viewer {

/// Address and port on which a viewer listens.
struct Listening {
  std::string address;  ///< as text, without brackets
  std::uint16_t port = 0;
  bool everywhere = false;  ///< on all of the machine's addresses
};

/// "127.0.0.1:8420", "[::1]:8420".
[[nodiscard]] std::string authority(const Listening& listening);

/// Does a request's Host name the address that is listened on, or localhost, and the port? Who
/// listens everywhere is named by any address written as a number, and by no other name: so no
/// foreign page can come here by a name that it had point to this machine.
[[nodiscard]] bool host_is_ours(std::string_view host, const Listening& listening);

/// Is a page that came by `host` the one that sends the request?
[[nodiscard]] bool origin_is_ours(std::string_view origin, std::string_view host);

/// 128 bits that nobody can guess, as 32 hexadecimal digits.
/// @throws Error when the system gives none.
[[nodiscard]] std::string make_token();

/// Is it one that a page can send and an address can end in: 1 to 256 letters, digits and any of
/// -._~?
[[nodiscard]] bool is_token(std::string_view token) noexcept;

/// Are they the same? How long it takes depends on `given`'s length alone.
[[nodiscard]] bool same_token(std::string_view given, std::string_view token) noexcept;

}  // namespace palpate::viewer
