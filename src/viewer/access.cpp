// Checks the hosts, origins and tokens of requests.
#include "viewer/access.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "palpate/base/error.hpp"
#include "viewer/messages.hpp"

namespace palpate::viewer {

namespace {

constexpr std::size_t kLongestHost = 128;  // bytes of a Host header (judgement)
constexpr std::uint16_t kHttpPort = 80;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

struct Named {
  std::string name;  // without brackets
  bool bracketed = false;
  std::string_view port;
};

std::optional<Named> split(std::string_view host) {
  if (host.empty() || host.size() > kLongestHost) return std::nullopt;
  Named named;
  std::string_view rest;
  if (host.front() == '[') {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    named.bracketed = true;
    named.name = host.substr(1, end - 1);
    rest = host.substr(end + 1);
  } else {
    const std::size_t colon = std::min(host.find(':'), host.size());
    named.name = host.substr(0, colon);
    rest = host.substr(colon);
  }
  if (!rest.empty() && (rest.front() != ':' || rest.size() == 1)) return std::nullopt;
  if (!rest.empty()) named.port = rest.substr(1);
  return named;
}

bool is_number(const Named& named) {
  std::array<unsigned char, 16> bytes{};
  return inet_pton(named.bracketed ? AF_INET6 : AF_INET, named.name.c_str(), bytes.data()) == 1;
}

}  // namespace

std::string authority(const Listening& listening) {
  const bool v6 = listening.address.find(':') != std::string::npos;
  return v6 ? fmt::format("[{}]:{}", listening.address, listening.port)
            : fmt::format("{}:{}", listening.address, listening.port);
}

bool host_is_ours(std::string_view host, const Listening& listening) {
  const std::optional<Named> named = split(host);
  if (!named) return false;
  const bool port_is_ours = named->port.empty() ? listening.port == kHttpPort
                                                : named->port == std::to_string(listening.port);
  if (!port_is_ours) return false;
  if (!named->bracketed && same_name(named->name, "localhost")) return true;
  if (listening.everywhere) return is_number(*named);
  return same_name(named->name, listening.address) && is_number(*named);
}

bool origin_is_ours(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.size() > kScheme.size() && same_name(origin.substr(0, kScheme.size()), kScheme) &&
         same_name(origin.substr(kScheme.size()), host);
}

std::string make_token() {
  std::array<unsigned char, 16> bits{};
  if (getentropy(bits.data(), bits.size()) != 0) {
    throw Error("viewer: no random bits for a token from the system; give a token");
  }
  std::string token;
  for (const unsigned char byte : bits) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_token(std::string_view token) noexcept {
  constexpr std::string_view kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  return !token.empty() && token.size() <= kLongestWord &&
         token.find_first_not_of(kAllowed) == std::string_view::npos;
}

bool same_token(std::string_view given, std::string_view token) noexcept {
  unsigned difference = given.size() == token.size() && !token.empty() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char expected = token.empty() ? '\0' : token[i % token.size()];
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(expected);
  }
  return difference == 0;
}

}  // namespace palpate::viewer
