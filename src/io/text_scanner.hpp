#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "io/input.hpp"

namespace palpate::io {

/// Walks through text: line by line, or token by token where white space is all that separates.
class TextScanner {
 public:
  explicit TextScanner(const Input& input, std::size_t offset = 0)
      : input_(input), text_(input.text()), offset_(offset) {}

  [[nodiscard]] bool at_end() const { return offset_ >= text_.size(); }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  void move_to(std::size_t offset) { offset_ = offset; }

  /// The rest of the current line without its end (LF, CR LF), and on to the next one.
  std::string_view next_line();

  /// The next token; empty at the end of the text.
  std::string_view next_token();

  /// The next token as a number; nothing at the end of the text.
  /// @throws Error for a token that is no number.
  std::optional<double> next_number();

 private:
  void skip_space();

  const Input& input_;
  std::string_view text_;
  std::size_t offset_;
};

/// A whole token as a number, in the C locale whatever the user's is; "nan" and "inf" count, a
/// leading plus too. What is too large for a double becomes infinite, what is too small zero.
[[nodiscard]] std::optional<double> parse_number(std::string_view token);

/// A whole token as a count.
[[nodiscard]] std::optional<std::size_t> parse_count(std::string_view token);

/// `text` without white space (and CR) around it.
[[nodiscard]] std::string_view trim(std::string_view text);

/// Takes the first blank-separated word off `text`; empty when none is left.
std::string_view take_word(std::string_view& text);

}  // namespace palpate::io
