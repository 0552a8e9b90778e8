#pragma once

#include <span>
#include <string>
#include <string_view>

namespace palpate::app {

/// What a key of a set-up file holds.
enum class KeyKind { text, path, number, integer, flag, numbers, numbers_or_text };

/// A key of a set-up file. It means what the option of its name means: both take the same values
/// and are checked alike.
struct SetupKey {
  std::string_view key;
  KeyKind kind = KeyKind::text;
};

/// That option: "--tool-radius" of "tool_radius".
[[nodiscard]] std::string option_of(std::string_view key);

/// The keys of [section]; empty: there is no such section. Those of "source" may stand in every
/// [[source]]; `name`, `from` and `pose` belong there as well.
[[nodiscard]] std::span<const SetupKey> keys_of(std::string_view section);

/// "stream, surface, ..."
[[nodiscard]] std::string section_names();

/// "radius, voxel, ..."
[[nodiscard]] std::string key_names(std::string_view section);

}  // namespace palpate::app
