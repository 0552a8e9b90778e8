// Reads well-known text (WKT 1 and 2), which describes systems of coordinates as a tree of
// brackets.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::io {

/// KEYWORD["value",number,CHILD[...]].
struct WktNode {
  std::string keyword;                     ///< in capitals
  std::vector<std::string_view> values{};  ///< texts without their quotes, numbers, names
  std::vector<WktNode> children{};
};

/// The tree of a text; nothing where its brackets or quotes do not close, or something else is
/// there. Systems in a row, as ESRI writes them, become children of COMPD_CS. Brackets may be
/// round.
[[nodiscard]] std::optional<WktNode> parse_wkt(std::string_view text);

}  // namespace palpate::io
