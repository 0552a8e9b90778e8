#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/file_bytes.hpp"

namespace palpate::io {

/// The bytes that base64 writes; nothing for text that is no base64.
[[nodiscard]] std::optional<Bytes> decode_base64(std::string_view text);

/// A path as an URI writes it, with %XX for some letters.
[[nodiscard]] std::string path_of_uri(std::string_view uri);

/// The file without links and "..", if it lies in the folder.
[[nodiscard]] std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                                               const std::filesystem::path& path);

}  // namespace palpate::io
