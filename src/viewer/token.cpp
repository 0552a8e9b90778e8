#include "viewer/token.hpp"

#include <fmt/core.h>
#include <sys/random.h>

#include <array>
#include <cstddef>

#include "palpate/base/error.hpp"
#include "viewer/client_message.hpp"

namespace palpate::viewer {

std::string make_token() {
  std::array<unsigned char, 16> bits{};
  if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size())) {
    throw Error("viewer: the system gives no random bits for a token; give one yourself");
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
