#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "base/parse_number.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// Type of a number in a binary file.
enum class NumberType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Bytes that a number of this type takes.
[[nodiscard]] constexpr std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

[[nodiscard]] constexpr bool is_floating(NumberType type) {
  return type == NumberType::float32 || type == NumberType::float64;
}

/// The type of a number of so many bytes: "I" signed, "U" unsigned, "F" with fractions; of either
/// case. None: there is no such type.
[[nodiscard]] std::optional<NumberType> number_type(std::string_view letter, std::size_t size);

/// A T read from unaligned bytes of the given byte order.
template <class T>
[[nodiscard]] T load_as(const std::byte* bytes, std::endian order = std::endian::little) {
  std::array<std::byte, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

/// The number at `bytes` as a double (64-bit integers beyond 2^53 are rounded).
[[nodiscard]] double load_number(NumberType type, const std::byte* bytes,
                                 std::endian order = std::endian::little);

/// Where a row of text begins, and how many values were taken from it.
struct TextRow {
  std::size_t begin = 0;
  std::size_t values = 0;
};

/// What some programs write before UTF-8; it means nothing.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The character that ends lines: CR where the first line ends with that alone, as on old
/// Macintoshes; else LF.
[[nodiscard]] char line_end_of(std::string_view text);

/// Walks through text: line by line, or token by token where white space is all that separates.
class TextScanner {
 public:
  /// Skips a byte-order mark at the start of the text.
  explicit TextScanner(const Input& input, std::size_t offset = 0)
      : input_(input), text_(input.text()), offset_(offset), line_end_(line_end_of(text_)) {
    if (offset == 0 && text_.starts_with(kByteOrderMark)) offset_ = kByteOrderMark.size();
  }

  [[nodiscard]] bool at_end() const { return offset_ >= text_.size(); }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  void move_to(std::size_t offset) { offset_ = offset; }

  /// The rest of the current line without its end (LF, CR LF, or CR in a text of such), and on to
  /// the next one.
  std::string_view next_line();

  /// The next token; empty at the end of the text.
  std::string_view next_token();

  /// The next token as a number; nothing at the end of the text.
  /// @throws Error for a token that is no number.
  std::optional<double> next_number();

  /// On to the next value, with which a row begins: lines without values are passed over.
  void begin_row();

  /// The row since begin_row().
  [[nodiscard]] TextRow row() const { return row_; }

  /// Does the line hold no further value?
  [[nodiscard]] bool at_line_end() const;

 private:
  void skip_space();

  const Input& input_;
  std::string_view text_;
  std::size_t offset_;
  char line_end_;
  TextRow row_;
};

/// The lines from `offset` on that hold values.
[[nodiscard]] std::size_t rows_from(const Input& input, std::size_t offset);

/// What a file's format reports of so many rows or records behind the last declared one: nothing of
/// none.
[[nodiscard]] std::string unused(std::size_t count);

/// A whole token as a count.
[[nodiscard]] std::optional<std::size_t> parse_count(std::string_view token);

/// `text` without white space (and CR) around it.
[[nodiscard]] std::string_view trim(std::string_view text);

/// Blank, or a comment: starts with #, // or %.
[[nodiscard]] bool is_blank_or_comment(std::string_view line);

/// Takes the first blank-separated word off `text`; empty when none is left.
std::string_view take_word(std::string_view& text);

}  // namespace palpate::io
