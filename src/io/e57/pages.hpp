// Declares the pages of E57 files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "io/input.hpp"

namespace palpate::io {

inline constexpr std::uint64_t kE57Page = 1024;              // bytes (format)
inline constexpr std::uint64_t kE57PageData = kE57Page - 4;  // bytes of data in a page (format)

/// The CRC-32C of a page's data.
[[nodiscard]] std::uint32_t e57_crc(const std::byte* data);

/// Reads the pages of an E57 file: 1020 bytes of data each and their CRC-32C, big endian. Offsets
/// count data bytes alone ("logical" in ASTM E2807); those that the file itself stores count the
/// CRCs, too ("physical").
class E57Pages {
 public:
  /// `input` must outlive this.
  explicit E57Pages(const Input& input) : input_(input) {}

  /// Data bytes of all whole pages.
  [[nodiscard]] std::uint64_t size() const;

  /// The logical offset of the `physical` one that the file stores.
  [[nodiscard]] static std::uint64_t logical_of(std::uint64_t physical);
  /// The byte of the file at `logical`, for messages.
  [[nodiscard]] static std::uint64_t byte_of(std::uint64_t logical);

  /// Makes `into` the `size` bytes from `logical` on, and checks the pages that hold them. `what`
  /// names them for messages.
  /// @throws Error when they lie beyond the end of the file, or a page's CRC is wrong.
  void read(std::uint64_t logical, std::uint64_t size, std::vector<std::byte>& into,
            std::string_view what);

 private:
  void check(std::uint64_t page);

  const Input& input_;
  std::uint64_t checked_ = std::numeric_limits<std::uint64_t>::max();  // the page that was last
};

}  // namespace palpate::io
