#pragma once

#include <span>
#include <string_view>

namespace palpate::viewer {

struct PageFile {
  std::string_view path;  ///< "/app.js"
  std::string_view type;  ///< MIME
  std::string_view bytes;
};

/// The page's files, held in the program. Where the page was not built, one that says how to.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace palpate::viewer
