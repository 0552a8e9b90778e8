#pragma once

#include <span>
#include <string>
#include <string_view>

namespace palpate::app {

/// What a key of a set-up file holds.
enum class KeyKind { text, texts, path, number, integer, flag, numbers, numbers_or_text };

/// A key of a set-up file. It means what the option of its name means: both take the same values
/// and are checked alike. Some have an option in set-up files alone (add_setup_options()).
struct SetupKey {
  std::string_view key;
  KeyKind kind = KeyKind::text;
};

/// That option: "--tool-radius" of "tool_radius".
[[nodiscard]] std::string option_of(std::string_view key);

/// The keys of [section]; empty: there is no such section. Those of "source" may stand in every
/// [[source]]; `name`, `from` and `pose` belong there as well.
[[nodiscard]] std::span<const SetupKey> keys_of(std::string_view section);

/// "[surface]" or "[[source]]", as it is written.
[[nodiscard]] std::string in_brackets(std::string_view section);

/// What is wrong with a part that no set-up has, and which it has.
[[nodiscard]] std::string unknown_section(std::string_view section);

/// What is wrong with a key that `section` does not have: where it belongs or what may be meant,
/// and which keys there are.
[[nodiscard]] std::string unknown_key(std::string_view section, std::string_view key);

}  // namespace palpate::app
