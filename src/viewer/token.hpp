#pragma once

#include <string>
#include <string_view>

namespace palpate::viewer {

/// 128 bits that nobody can guess, as 32 hexadecimal digits.
/// @throws Error when the system gives none.
[[nodiscard]] std::string make_token();

/// Is it one that a page can say and an address can end in: 1 to 256 letters, digits and any of
/// -._~?
[[nodiscard]] bool is_token(std::string_view token) noexcept;

/// Are they the same? How long it takes tells of `given`'s length alone.
[[nodiscard]] bool same_token(std::string_view given, std::string_view token) noexcept;

}  // namespace palpate::viewer
