// Words the errors of readers, and takes names of files apart.
#include "io/input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "io/formats.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io {

FileUnit given_unit(const ReadOptions& options) {
  FileUnit unit;
  if (!options.scale) return unit;
  unit.plan = *options.scale;
  unit.height = options.height_scale.value_or(*options.scale);
  unit.source = FileUnit::Source::given;
  return unit;
}

void fail(const Input& input, std::string_view what, std::string_view remedy) {
  throw Error(fmt::format("{}: {}. {}.", input.name, what, remedy));
}

void fail_at_byte(const Input& input, std::size_t offset, std::string_view what,
                  std::string_view remedy) {
  throw Error(fmt::format("{}, byte {}: {}. {}.", input.name, offset, what, remedy));
}

void fail_at_line(const Input& input, std::size_t offset, std::string_view what,
                  std::string_view remedy) {
  const std::string_view before = input.text().substr(0, offset);
  const auto line = std::count(before.begin(), before.end(), line_end_of(input.text())) + 1;
  throw Error(fmt::format("{}, line {}: {}. {}.", input.name, line, what, remedy));
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result{text.substr(0, kLongest)};
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kLongest ? result + "..." : result;
}

std::string lower_case(std::string_view text) {
  std::string result{text};
  std::ranges::transform(result, result.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return result;
}

std::string extension(std::string_view name) {
  const std::size_t dot = name.find_last_of("./");
  if (dot == std::string_view::npos || name[dot] != '.') return {};
  return lower_case(name.substr(dot));
}

ScanName split_scan(const std::string& name) {
  const std::size_t mark = name.rfind('#');
  if (mark == std::string::npos || extension(name.substr(0, mark)) != ".e57") return {name};
  const std::optional<std::size_t> number = parse_count(std::string_view(name).substr(mark + 1));
  return number ? ScanName{name.substr(0, mark), number} : ScanName{name};
}

}  // namespace palpate::io
