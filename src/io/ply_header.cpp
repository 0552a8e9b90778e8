// Parses the header of PLY files.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/formats.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::pair<std::string_view, NumberType> kTypes[] = {
    {"char", NumberType::int8},       {"uchar", NumberType::uint8},
    {"short", NumberType::int16},     {"ushort", NumberType::uint16},
    {"int", NumberType::int32},       {"uint", NumberType::uint32},
    {"float", NumberType::float32},   {"double", NumberType::float64},
    {"int8", NumberType::int8},       {"uint8", NumberType::uint8},
    {"int16", NumberType::int16},     {"uint16", NumberType::uint16},
    {"int32", NumberType::int32},     {"uint32", NumberType::uint32},
    {"int64", NumberType::int64},     {"uint64", NumberType::uint64},
    {"float32", NumberType::float32}, {"float64", NumberType::float64},
};

// Elements and properties; no honest file has more (judgement)
constexpr std::size_t kMostColumns = 4096;

class PlyHeaderParser {
 public:
  explicit PlyHeaderParser(const Input& input) : input_(input), scanner_(input) {}

  PlyHeader run() {
    (void)scanner_.next_line();  // "ply": that is how we came here
    while (true) {
      if (scanner_.at_end()) {
        fail(input_, "the PLY header has no end_header line",
             "The file is truncated: download it again");
      }
      line_begin_ = scanner_.offset();
      std::string_view line = scanner_.next_line();
      const std::string_view keyword = take_word(line);
      if (keyword == "end_header") break;
      take(keyword, line);
    }
    if (!has_format_) fail(input_, "the PLY header has no format line", "Export the file again");
    header_.size = scanner_.offset();
    return std::move(header_);
  }

 private:
  void take(std::string_view keyword, std::string_view rest) {
    if (keyword == "format") return take_format(take_word(rest));
    if (keyword == "element") return take_element(rest);
    if (keyword == "property") return take_property(rest);
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return;
    wrong(fmt::format("unknown word \"{}\" in the PLY header", excerpt(keyword)));
  }

  void take_format(std::string_view word) {
    constexpr std::pair<std::string_view, PlyEncoding> kEncodings[] = {
        {"ascii", PlyEncoding::ascii},
        {"binary_little_endian", PlyEncoding::little_endian},
        {"binary_big_endian", PlyEncoding::big_endian}};
    for (const auto& [name, encoding] : kEncodings) {
      if (name != word) continue;
      header_.encoding = encoding;
      has_format_ = true;
      return;
    }
    wrong(fmt::format("unknown PLY format \"{}\"", excerpt(word)));
  }

  void take_element(std::string_view rest) {
    const std::string_view name = take_word(rest);
    const std::string_view word = take_word(rest);
    const std::optional<std::size_t> count = parse_count(word);
    if (name.empty() || !count) wrong(fmt::format("\"{}\" is not an element count", excerpt(word)));
    count_column();
    header_.elements.push_back({std::string(name), *count, {}});
  }

  void take_property(std::string_view rest) {
    if (header_.elements.empty()) wrong("a property comes before any element");
    count_column();
    PlyProperty property;
    std::string_view word = take_word(rest);
    if (word == "list") {
      property.list_count = type(take_word(rest));
      if (is_floating(*property.list_count)) wrong("the length type of a list is not an integer");
      word = take_word(rest);
    }
    property.type = type(word);
    property.name = take_word(rest);
    header_.elements.back().properties.push_back(std::move(property));
  }

  NumberType type(std::string_view word) {
    const auto* found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                     [&](const auto& entry) { return entry.first == word; });
    if (found == std::end(kTypes)) wrong(fmt::format("unknown type \"{}\"", excerpt(word)));
    return found->second;
  }

  void count_column() {
    if (++columns_ > kMostColumns) wrong("more than 4096 elements and properties");
  }

  [[noreturn]] void wrong(std::string_view what) {
    fail_at_line(input_, line_begin_, what, "Correct the header, or export the file again as PLY");
  }

  const Input& input_;
  TextScanner scanner_;
  PlyHeader header_;
  std::size_t line_begin_ = 0;
  std::size_t columns_ = 0;
  bool has_format_ = false;
};

}  // namespace

PlyHeader read_ply_header(const Input& input) {
  return PlyHeaderParser(input).run();
}

}  // namespace palpate::io
