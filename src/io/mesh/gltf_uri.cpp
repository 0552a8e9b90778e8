// Reads what URIs of a glTF file hold or name.
#include "io/mesh/gltf_uri.hpp"

#include <algorithm>
#include <charconv>

namespace palpate::io {

namespace {

// Six bits of a letter of base64; 64: it is none.
unsigned six_bits(char c) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return static_cast<unsigned>(std::min(kLetters.find(c), kLetters.size()));
}

}  // namespace

std::optional<Bytes> decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  Bytes bytes(text.size() * 3 / 4);
  unsigned held = 0;  // bits that no byte has been made of yet
  int bits = 0;
  std::size_t done = 0;
  for (const char c : text) {
    const unsigned six = six_bits(c);
    if (six == 64) return {};
    held = (held << 6U | six) & 0xFFFFU;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.span()[done++] = static_cast<std::byte>(held >> static_cast<unsigned>(bits));
  }
  return bytes;
}

std::string path_of_uri(std::string_view uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char* const begin = uri.data() + i + 1;
    const bool coded = uri[i] == '%' && i + 2 < uri.size() &&
                       std::from_chars(begin, begin + 2, code, 16).ptr == begin + 2;
    path += coded ? static_cast<char>(code) : uri[i];
    if (coded) i += 2;
  }
  return path;
}

std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                                 const std::filesystem::path& path) {
  std::error_code failed;
  const auto root = weakly_canonical(folder, failed);
  if (failed || path.is_absolute() || path.empty()) return {};
  auto file = weakly_canonical(folder / path, failed);
  if (failed || std::ranges::mismatch(root, file).in1 != root.end()) return {};
  return file;
}

}  // namespace palpate::io
