// Reads well-known text as a tree.
#include "io/units/wkt.hpp"

#include <algorithm>
#include <utility>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr int kDeepest = 64;  // brackets in one another; systems have some ten (judgement)

class WktParser {
 public:
  explicit WktParser(std::string_view text) : text_(text) {}

  std::optional<WktNode> run() {
    WktNode all{"COMPD_CS"};
    do {
      auto node = read_node(take_name(), 0);
      if (!node) return {};
      all.children.push_back(*std::move(node));
    } while (take(',', ','));
    skip_blanks();
    if (!text_.empty()) return {};
    return all.children.size() == 1 ? std::move(all.children.front()) : std::move(all);
  }

 private:
  void skip_blanks() {
    while (!text_.empty() && is_space(text_.front())) text_.remove_prefix(1);
  }

  bool take(char wanted, char other) {
    skip_blanks();
    if (text_.empty() || (text_.front() != wanted && text_.front() != other)) return false;
    text_.remove_prefix(1);
    return true;
  }

  // A keyword, a number, or a name without quotes.
  std::string_view take_name() {
    skip_blanks();
    const std::size_t end = std::min(text_.find_first_of("[](),\""), text_.size());
    const std::string_view name = text_.substr(0, end);
    text_.remove_prefix(end);
    return trim(name);
  }

  // The text between quotes, of which two in a row are one in it.
  std::optional<std::string_view> take_quoted() {
    std::size_t end = text_.find('"', 1);
    while (end != std::string_view::npos && text_.substr(end + 1).starts_with('"')) {
      end = text_.find('"', end + 2);
    }
    if (end == std::string_view::npos) return {};
    const std::string_view quoted = text_.substr(1, end - 1);
    text_.remove_prefix(end + 1);
    return quoted;
  }

  // What follows the keyword: brackets and all in them.
  std::optional<WktNode> read_node(std::string_view keyword, int depth) {
    if (keyword.empty() || depth > kDeepest || !take('[', '(')) return {};
    WktNode node{std::string(keyword)};
    std::ranges::transform(node.keyword, node.keyword.begin(), [](char c) {
      return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
    });
    do {
      skip_blanks();
      if (text_.starts_with('"')) {
        const auto quoted = take_quoted();
        if (!quoted) return {};
        node.values.push_back(*quoted);
        continue;
      }
      const std::string_view name = take_name();
      if (!text_.starts_with('[') && !text_.starts_with('(')) {
        node.values.push_back(name);
        continue;
      }
      auto child = read_node(name, depth + 1);
      if (!child) return {};
      node.children.push_back(*std::move(child));
    } while (take(',', ','));
    if (!take(']', ')')) return {};
    return node;
  }

  std::string_view text_;
};

}  // namespace

std::optional<WktNode> parse_wkt(std::string_view text) {
  return WktParser(text.substr(0, text.find('\0'))).run();
}

}  // namespace palpate::io
